"""One JSBSim aircraft, in SI and radians: its controls, its steps, its state.

JSBSim's feet, pounds and property paths end here. Every property is looked up once, when the
airframe is made, and kept as the bound method of its node: a read costs 20 ns that way, against
250 ns by path.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import jsbsim

from airhilt.units import DEGREE, FOOT, INCH, KNOT, POUND
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.model import ModelError, load_model
from airhilt.world.flight.state import AircraftState, Atmosphere, InitialCondition, OnGround

PASCAL_PER_PSF = 47.880258980336
"""Pascal in a pound-force per square foot (lbf = 4.4482216152605 N, ft = 0.3048 m)."""
MILITARY_SPECIFICATION = 3
"""JSBSim's ``turb-type`` for the MIL-F-8785C turbulence model."""
BOTH_MAGNETOS = 3
"""JSBSim's ``magneto_cmd`` for a running piston engine."""
CRUISE_LEVER = 0.7
"""Throttle lever at which piston engines are started."""
MAIN_WHEELS = (1, 2)
"""JSBSim's numbers of the left and the right main gear; 0 is the nose gear."""
FULL_WIND_M_S = 15.0
"""Ground speed from which an aircraft on the ground feels the whole wind and turbulence, in m/s.

A slower aircraft feels a part of them in proportion. The models' coefficients are linear in the
angle of attack, which reaches 180 degrees in a tailwind and is undefined in a pure crosswind: they
would rear a standing aircraft up."""

STATE = (
    ("position/lat-geod-rad", 1.0), ("position/long-gc-rad", 1.0), ("position/geod-alt-ft", FOOT),
    ("velocities/v-north-fps", FOOT), ("velocities/v-east-fps", FOOT),
    ("velocities/v-down-fps", FOOT), ("attitude/phi-rad", 1.0), ("attitude/theta-rad", 1.0),
    ("attitude/psi-rad", 1.0), ("velocities/vt-fps", FOOT), ("velocities/vc-kts", KNOT),
    ("velocities/mach", 1.0), ("position/ecef-x-ft", FOOT), ("position/ecef-y-ft", FOOT),
    ("position/ecef-z-ft", FOOT),
)  # fmt: skip
"""Properties of an `AircraftState` in the order of its fields, without the height above ground, and
their units."""

Reader = Callable[[], float]
Writer = Callable[[float], object]


class Airframe:
    """A JSBSim aircraft on, or above, flat ground at an elevation; the seed is that of turbulence.

    Raises
    ------
    ModelError
        JSBSim does not have the model.
    """

    def __init__(
        self,
        kind: AircraftType,
        *,
        step_s: float,
        seed: int,
        terrain_elevation_m: float,
        load: float = 0.0,
    ) -> None:
        self._fdm = fdm = load_model(kind.jsbsim_model, step_s, load)
        self._kind = kind
        self._seed = seed
        self._wheels_on_ground_m = terrain_elevation_m + kind.dimensions.wheel_height_offset_m
        self._engines = fdm.get_propulsion().get_num_engines()
        self._failed_engines = 0
        fdm["ic/terrain-elevation-ft"] = terrain_elevation_m / FOOT

        self.step: Callable[[], bool] = fdm.run
        """Integrate one step of the flight dynamics."""
        self._find_motion()
        self._find_controls()
        self._find_wheels()
        writer = self._writer
        self._set_wind_north = writer("atmosphere/wind-north-fps")
        self._set_wind_east = writer("atmosphere/wind-east-fps")
        self._set_gusts = writer("atmosphere/turbulence/milspec/windspeed_at_20ft_AGL-fps")
        self._wind_fps = 0.0, 0.0, 0.0
        self._wind_part = 1.0

    def _find_motion(self) -> None:
        """Look up the properties of the aircraft's motion."""
        reader = self._reader
        self._state = [(reader(path), unit) for path, unit in STATE]
        self._dynamic_pressure_psf = reader("aero/qbar-psf")

        self.angle_of_attack = reader("aero/alpha-rad")
        """Reads the angle of attack, in rad. The next five read the load factor, the sideslip in
        rad, and the rates of roll, pitch and yaw in rad/s."""
        self.load_factor = reader("accelerations/Nz")
        self.sideslip = reader("aero/beta-rad")
        self.roll_rate = reader("velocities/p-rad_sec")
        self.pitch_rate = reader("velocities/q-rad_sec")
        self.yaw_rate = reader("velocities/r-rad_sec")

        self.gear = reader("gear/gear-pos-norm")
        """Reads the gear (0 up, 1 down)."""
        self.flaps = reader("fcs/flap-pos-norm")
        """Reads the flaps (0 up, 1 fully extended)."""
        self._fuel_lb = reader("propulsion/total-fuel-lbs")

    def _find_controls(self) -> None:
        """Look up the properties of the controls."""
        reader, writer = self._reader, self._writer
        self.elevator = reader("fcs/elevator-cmd-norm")
        """Reads the elevator (-1..1). The next three read aileron, rudder and throttle."""
        self.aileron = reader("fcs/aileron-cmd-norm")
        self.rudder = reader("fcs/rudder-cmd-norm")
        self.throttle = reader("fcs/throttle-cmd-norm")

        self.set_elevator = writer("fcs/elevator-cmd-norm")
        """Sets the elevator (-1..1, positive pitches down)."""
        self.set_aileron = writer("fcs/aileron-cmd-norm")
        """Sets the aileron (-1..1, positive rolls right)."""
        self.set_rudder = writer("fcs/rudder-cmd-norm")
        """Sets the rudder (-1..1, positive yaws left)."""
        self.set_flaps = writer("fcs/flap-cmd-norm")
        """Sets the flaps (0..1). The next three set the gear (1 is down), the speed brakes and
        the ground spoilers, where there are any."""
        self.set_gear = writer("gear/gear-cmd-norm")
        self.set_speed_brakes = writer("fcs/speedbrake-cmd-norm")
        self.set_ground_spoilers = writer("fcs/spoiler-cmd-norm")
        self._throttles = [
            writer("fcs/throttle-cmd-norm" + (f"[{engine}]" if engine else ""))
            for engine in range(self._engines)
        ]

    def _find_wheels(self) -> None:
        """Look up the properties of nose wheel, brakes and loads on wheels."""
        reader, writer = self._reader, self._writer
        self._steer = writer("fcs/steer-cmd-norm")
        self._brakes = [writer(f"fcs/{side}-brake-cmd-norm") for side in ("left", "right")]
        self._nose_wheel_on_ground = reader("gear/unit[0]/WOW")
        self._main_wheels_on_ground = [reader(f"gear/unit[{wheel}]/WOW") for wheel in MAIN_WHEELS]

    def start(self, initial: InitialCondition, heading_rad: float) -> None:
        """Put the aircraft into still air at a condition, engines running, untrimmed."""
        fdm = self._fdm
        self._set_place(initial, initial.altitude_m, heading_rad)
        fdm["ic/vc-kts"] = initial.calibrated_airspeed_m_s / KNOT
        fdm["ic/roc-fps"] = initial.vertical_rate_m_s / FOOT
        gear, flaps = (1.0, self._kind.landing.flaps) if initial.on_approach else (0.0, 0.0)
        self._initialise(gear, flaps)

    def start_on_ground(self, place: OnGround) -> None:
        """Put the aircraft on its wheels in still air, engines running, flaps set for takeoff."""
        self._set_place(place, self._wheels_on_ground_m, place.heading_rad)
        self._fdm["ic/vc-kts"] = 0.0
        self._initialise(1.0, self._kind.takeoff.flaps)

    def _set_place(
        self, place: InitialCondition | OnGround, altitude_m: float, heading_rad: float
    ) -> None:
        """Set where the aircraft begins: JSBSim needs the place before the speed."""
        fdm = self._fdm
        fdm["simulation/randomseed"] = self._seed
        fdm["ic/lat-geod-rad"] = place.latitude_rad
        fdm["ic/long-gc-rad"] = place.longitude_rad
        fdm["ic/h-sl-ft"] = altitude_m / FOOT
        fdm["ic/psi-true-rad"] = heading_rad

    def _initialise(self, gear: float, flaps: float) -> None:
        """Run JSBSim's initial conditions, then read the positions of the wheels from the model."""
        fdm = self._fdm
        for engine in range(self._engines):
            index = f"[{engine}]" if engine else ""
            fdm[f"fcs/mixture-cmd-norm{index}"] = 1.0
            fdm[f"fcs/advance-cmd-norm{index}"] = 1.0
        fdm.run_ic()
        fdm["propulsion/set-running"] = -1
        fdm["gear/gear-cmd-norm"] = fdm["gear/gear-pos-norm"] = gear
        fdm["fcs/flap-cmd-norm"] = fdm["fcs/flap-pos-norm"] = flaps
        main = f"gear/unit[{MAIN_WHEELS[0]}]"
        x, z = fdm[f"{main}/x-position"], fdm[f"{main}/z-position"]
        self.wheelbase_m = (x - fdm["gear/unit[0]/x-position"]) * INCH
        self._wheels_below_m = (fdm["inertia/cg-z-in"] - z) * INCH
        self._wheels_aft_m = -(fdm["inertia/cg-x-in"] - x) * INCH

    def set_atmosphere(self, atmosphere: Atmosphere) -> None:
        """Put the aircraft that stands on the ground into the wind of an atmosphere."""
        fdm = self._fdm
        self._make_turbulent(atmosphere)
        self._keep_wind(atmosphere)
        self.set_wind_for_ground_speed(0.0)
        fdm["simulation/randomseed"] = self._seed
        fdm["propulsion/starter_cmd"] = 0

    def set_wind_for_ground_speed(self, ground_speed_m_s: float) -> None:
        """Set the part of the wind that the model can stand on the ground at this speed."""
        part = min(ground_speed_m_s / FULL_WIND_M_S, 1.0)
        if part != self._wind_part:
            self._wind_part = part
            north, east, gusts = self._wind_fps
            self._set_wind_north(part * north)
            self._set_wind_east(part * east)
            self._set_gusts(part * gusts)

    def _keep_wind(self, atmosphere: Atmosphere) -> None:
        wind, gusts = atmosphere, atmosphere.turbulence_wind_at_20ft_m_s
        self._wind_fps = wind.wind_north_m_s / FOOT, wind.wind_east_m_s / FOOT, gusts / FOOT

    def fuel_kg(self) -> float:
        """Return the mass of the fuel in all tanks, in kg."""
        return self._fuel_lb() * POUND

    def crank(self) -> None:
        """Start piston engines with their starters, the throttles at cruise power.

        JSBSim's ``set-running`` leaves a constant-speed propeller at a pitch that stops the engine.
        """
        self._fdm["propulsion/magneto_cmd"] = BOTH_MAGNETOS
        self._fdm["propulsion/starter_cmd"] = 1
        self.set_throttle(CRUISE_LEVER)

    def trim(self) -> None:
        """Find and set the controls and the attitude of steady flight, or raise `ModelError`."""
        try:
            self._fdm.do_trim(int(jsbsim.TrimMode.FULL))
        except jsbsim.TrimFailureError as error:
            state = self.state()
            raise ModelError(
                f"{self._kind.name} cannot fly steadily at "
                f"{state.calibrated_airspeed_m_s / KNOT:.0f} kt at {state.altitude_m / FOOT:.0f} ft"
            ) from error

    def release(self, initial: InitialCondition, atmosphere: Atmosphere) -> None:
        """Move the aircraft, as it flies now in still air, to a place and into moving air."""
        fdm = self._fdm
        north, east, down = (fdm[f"velocities/v-{way}-fps"] for way in ("north", "east", "down"))
        roll, pitch, heading = (fdm[f"attitude/{angle}-rad"] for angle in ("phi", "theta", "psi"))
        rates = self.roll_rate(), self.pitch_rate(), self.yaw_rate()
        wind_north, wind_east = atmosphere.wind_north_m_s / FOOT, atmosphere.wind_east_m_s / FOOT
        self._keep_wind(atmosphere)
        fdm["ic/lat-geod-rad"] = initial.latitude_rad
        fdm["ic/long-gc-rad"] = initial.longitude_rad
        fdm["ic/h-sl-ft"] = initial.altitude_m / FOOT
        fdm["ic/phi-rad"] = roll + initial.bank_rad
        fdm["ic/theta-rad"] = pitch
        fdm["ic/psi-true-rad"] = heading
        # In this order: a direction set on no wind is lost. It is where the wind blows to, whatever
        # JSBSim's manual says.
        fdm["ic/vw-mag-fps"] = math.hypot(wind_north, wind_east)
        fdm["ic/vw-dir-deg"] = math.degrees(math.atan2(wind_east, wind_north))
        fdm["ic/vn-fps"] = north + wind_north
        fdm["ic/ve-fps"] = east + wind_east
        fdm["ic/vd-fps"] = down
        fdm["ic/p-rad_sec"], fdm["ic/q-rad_sec"], fdm["ic/r-rad_sec"] = rates
        self._make_turbulent(atmosphere)
        fdm["simulation/randomseed"] = self._seed
        fdm.run_ic()
        fdm["simulation/randomseed"] = self._seed
        fdm["propulsion/starter_cmd"] = 0

    def _make_turbulent(self, atmosphere: Atmosphere) -> None:
        fdm = self._fdm
        if atmosphere.turbulence_severity or atmosphere.turbulence_wind_at_20ft_m_s:
            turbulence = "atmosphere/turbulence/milspec"
            fdm["atmosphere/turb-type"] = MILITARY_SPECIFICATION
            fdm[f"{turbulence}/severity"] = atmosphere.turbulence_severity
            fdm[f"{turbulence}/windspeed_at_20ft_AGL-fps"] = (
                atmosphere.turbulence_wind_at_20ft_m_s / FOOT
            )

    def on_ground(self) -> bool:
        """Return whether a main wheel carries weight."""
        left, right = self._main_wheels_on_ground
        return left() > 0.0 or right() > 0.0

    def nose_on_ground(self) -> bool:
        """Return whether the nose wheel carries weight."""
        return self._nose_wheel_on_ground() > 0.0

    def set_nose_wheel(self, angle_rad: float) -> None:
        """Turn the nose wheel, positive to the right."""
        self._steer(angle_rad / (self._kind.ground.model_nose_wheel_deg * DEGREE))

    def set_brakes(self, pedals: float) -> None:
        """Set both brakes (0..1)."""
        for brake in self._brakes:
            brake(pedals)

    def main_wheel_height_m(self, state: AircraftState) -> float:
        """Return how far the unloaded main wheels are above the ground at this pitch."""
        pitch = state.pitch_rad
        return (
            state.height_agl_m
            + self._kind.dimensions.wheel_height_offset_m
            - self._wheels_below_m * math.cos(pitch)
            - self._wheels_aft_m * math.sin(pitch)
        )

    def clean_up(self) -> None:
        """Retract gear, flaps and speed brakes."""
        for retract in (self.set_gear, self.set_flaps, self.set_speed_brakes):
            retract(0.0)

    def require_engine(self, engine: int) -> None:
        """Raise ValueError unless there is such an engine (counted from 0)."""
        if engine not in range(self._engines):
            raise ValueError(f"engine is {engine}; expected 0 to {self._engines - 1}")

    def cut_engine(self, engine: int) -> None:
        """Stop an engine (counted from 0) for good.

        ``set-running`` alone does not: the engine starts again.
        """
        fdm = self._fdm
        self._failed_engines += 1
        fdm["propulsion/active_engine"] = engine
        fdm["propulsion/cutoff_cmd"] = 1
        fdm["propulsion/magneto_cmd"] = 0
        fdm["propulsion/active_engine"] = -1

    def has_failed_engine(self) -> bool:
        """Return whether an engine has been stopped for good."""
        return self._failed_engines > 0

    def set_throttle(self, lever: float) -> None:
        """Set the throttle levers of all engines (0..1)."""
        for set_lever in self._throttles:
            set_lever(lever)

    def dynamic_pressure_pa(self) -> float:
        """Return the dynamic pressure (Pa)."""
        return self._dynamic_pressure_psf() * PASCAL_PER_PSF

    def state(self) -> AircraftState:
        """Read the state."""
        values = [read() * unit for read, unit in self._state]
        height_m = values[2] - self._wheels_on_ground_m
        return AircraftState._make([*values[:3], height_m, *values[3:]])

    def _reader(self, path: str) -> Reader:
        read: Reader = self._node(path).get_double_value
        return read

    def _writer(self, path: str) -> Writer:
        write: Writer = self._node(path).set_double_value
        return write

    def _node(self, path: str) -> Any:
        node = self._fdm.get_property_manager().get_node(path)
        if node is None:
            raise ModelError(f"{self._kind.name} has no JSBSim property {path}")
        return node
