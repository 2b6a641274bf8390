"""The ``aircraft/*.json`` files: an aircraft type, and the gains that fly it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from airhilt.host import library
from airhilt.quantities import Name, Number, Share, VerticalRateFpm
from airhilt.scenario import documents
from airhilt.scenario.problems import validated
from airhilt.shapes.aircraft.spec import AircraftCategory, AircraftDimensions, AircraftMesh

MOST_GAIN = 1000
"""Greatest number of a gain or a time constant, far above that of any aircraft."""
Gain = Annotated[Number, Field(ge=0, le=MOST_GAIN)]
"""Gain that may be 0: then its part is left out."""
LoopGain = Annotated[Number, Field(gt=0, le=MOST_GAIN)]
"""Gain or time constant without which nothing is controlled."""
Knots = Annotated[Number, Field(gt=0, le=1000)]
"""Speed of flight or of taxiing, in kt."""
Degrees = Annotated[Number, Field(gt=0, le=90)]
"""Angle between two parts of an aircraft, or to the ground, in degrees."""
DegreesPerS = Annotated[Number, Field(gt=0, le=180)]
"""Rate of turning about an axis, in degrees/s."""
Lever = Annotated[Number, Field(gt=0, le=1)]
"""Position of the throttle levers; 1 is the model's full thrust."""
DistanceM = Annotated[Number, Field(gt=0, le=100_000)]
"""Distance over the ground, in m."""
DecelerationMS2 = Annotated[Number, Field(gt=0, le=50)]
"""Deceleration on the wheels, in m/s2."""


class _Section(pydantic.BaseModel):
    model_config = pydantic.ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Speeds(_Section):
    """Calibrated airspeeds in knots, and the limits that guidance keeps."""

    approach_kt: Knots
    rotate_kt: Knots
    climb_safety_kt: Knots
    """V2."""
    drift_down_kt: Knots
    """Speed after an engine failure en route; best glide speed of an aircraft with one engine."""
    cruise_kt: Knots
    minimum_clean_kt: Knots
    maximum_kt: Knots
    """Vmo, or Vno for a piston aircraft."""
    maximum_mach: Number = Field(gt=0, le=5)
    service_ceiling_ft: Number = Field(gt=0, le=100_000)
    climb_rate_fpm: VerticalRateFpm
    """Rate of a climb or descent for which none was asked."""
    maximum_climb_rate_fpm: VerticalRateFpm
    maximum_descent_rate_fpm: VerticalRateFpm


class PitchGains(_Section):
    """Attitude to pitch rate to elevator (normalised, -1..1).

    Elevator and ailerons work against dynamic pressure: their gains hold at
    ``reference_pressure_pa``.
    """

    attitude_per_s: LoopGain
    rate_limit_deg_s: DegreesPerS
    rate_s: Gain
    rate_integral: Gain
    zero_lift_angle_deg: Number = Field(ge=-90, le=90)
    """Angle of attack without lift, flaps up."""
    reference_pressure_pa: Number = Field(gt=0, le=100_000)


class RollGains(_Section):
    """Bank to roll rate to aileron (normalised, -1..1)."""

    bank_limit_deg: Number = Field(gt=0, le=45)
    bank_rate_limit_deg_s: DegreesPerS
    bank_per_s: LoopGain
    rate_s: Gain
    rate_integral: Gain


class YawGains(_Section):
    """Sideslip and yaw rate (against that of a coordinated turn) to rudder (normalised, -1..1)."""

    sideslip: Gain
    sideslip_integral_per_s: Gain
    rate_s: Gain


class ThrustGains(_Section):
    """Airspeed to throttle lever (0..1)."""

    speed_s_m: Gain
    speed_integral_m: Gain
    acceleration_s2_m: Gain
    climb_angle: Gain
    lever_rate_per_s: LoopGain


class GuidanceGains(_Section):
    """Course error to turn rate, altitude error to vertical rate."""

    course_per_s: LoopGain
    altitude_per_s: LoopGain


class Gains(_Section):
    """All control gains of a type; angles in radians where a gain multiplies one."""

    pitch: PitchGains
    roll: RollGains
    yaw: YawGains
    thrust: ThrustGains
    guidance: GuidanceGains


class Rates(_Section):
    """Rates in the air, far from any runway, at which the type is stable all over its envelope."""

    steps_hz: Literal[60, 120] = 120
    """Steps of the flight dynamics in a second."""
    law_hz: Literal[10, 20] = 20
    """Times in a second at which guidance and autopilot set the controls."""


class Ground(_Section):
    """Rolling and taxiing."""

    model_nose_wheel_deg: Degrees
    """Angle of the JSBSim model's nose wheel at full command; the model obeys more than full."""
    nose_wheel_limit_deg: Number = Field(gt=0, lt=90)
    """Greatest angle of the real aircraft's nose wheel."""
    yaw_rate_s: LoopGain
    """Rudder per error of yaw rate, and of its integral."""
    yaw_integral: Gain
    deceleration_m_s2: DecelerationMS2
    """Deceleration after touchdown."""
    taxi_speed_kt: Knots
    look_ahead_m: DistanceM
    """Least distance of the point on a path that is steered to."""
    tail_contact_deg: Degrees
    """Pitch, on the main wheels, at which the tail touches the ground: of the Boeings as their
    flight crew training manuals have it, of the Cessnas from the JSBSim model's tail skid."""
    wing_contact_deg: Degrees
    """Bank, on one main wheel, at which a wing tip or an engine touches the ground: of the 747 as
    its flight manual warns (BFU Bulletin, October 2014), of the 737 about, of the Cessnas from the
    JSBSim model's wing tips."""


class Flare(_Section):
    """The flare: sink rate ``height / time_constant_s + touchdown_rate_fpm``, and its pitch law."""

    time_constant_s: LoopGain
    touchdown_rate_fpm: VerticalRateFpm
    decrab_height_m: Number = Field(ge=0, le=1000)
    """Height of the main wheels below which the rudder points the nose along the runway."""
    idle_height_part: Number = Field(ge=0, lt=1)
    """Part of the flare's initial height at which the levers have come to idle."""
    climb: LoopGain
    """Pitch per error of climb angle; `airhilt.world.flight.autopilot.PitchLaw` says the rest."""
    climb_integral_per_s: Gain
    climb_rate_s: Gain
    attitude_per_s: LoopGain


class Landing(_Section):
    """Configuration and guidance of approach and landing."""

    flaps: Share
    """Part of the model's full deflection."""
    aim_m: DistanceM
    """Distance from the threshold to where the main wheels' glide path meets the runway."""
    configure_m: DistanceM
    """Distance from the threshold at which gear and flaps are lowered."""
    course_per_s: LoopGain
    """Turn rate per course error on the localizer."""
    glide_per_s: LoopGain
    """Vertical rate per height error on the glide path."""
    flare: Flare


class Takeoff(_Section):
    """Configuration, thrust and rotation.

    The levers are those at which the JSBSim models climb as published. Jets take off with reduced
    thrust: a derate, and up to a quarter less for an assumed temperature (FAA AC 25-13). The models
    of the Cessnas have more power, or less weight, than the aircraft of the handbooks.
    """

    flaps: Share
    """Part of the model's full deflection."""
    lever: Lever
    """Throttle lever of the takeoff, up to the acceleration height."""
    climb_lever: Lever
    """Throttle lever of the climb above that."""
    pitch_deg: Degrees
    """Pitch after the rotation, below the pitch at which the tail touches."""
    pitch_rate_deg_s: DegreesPerS
    pull: Number = Field(ge=0, lt=1)
    """Elevator at the beginning of the rotation; it lifts the nose wheel at rotation speed."""
    rejected_deceleration_m_s2: DecelerationMS2
    """Deceleration of a rejected takeoff."""


class AircraftType(_Section):
    """One ``aircraft/*.json``."""

    name: Name
    jsbsim_model: str = Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$")
    """Folder of the model in the JSBSim wheel."""
    icao_designator: str = Field(pattern=r"^[A-Z][A-Z0-9]{1,3}$")
    """ICAO Doc 8643."""
    description: str = Field(max_length=500)
    category: AircraftCategory
    dimensions: AircraftDimensions
    speeds: Speeds
    start: Literal["trim", "settle"]
    """Way to the model's equilibrium: JSBSim's trim, or flying until it is steady."""
    gains: Gains
    rates: Rates = Rates()
    ground: Ground
    takeoff: Takeoff
    landing: Landing
    mesh: AircraftMesh


def load_aircraft_type(name: str, files: Mapping[str, Any] = MappingProxyType({})) -> AircraftType:
    """Return the aircraft type of that name, from ``files`` or from those that ship with AIRHILT.

    A ScenarioError says that there is none, or where in its file what was expected.
    """
    if name in files:
        return validated(AircraftType, files[name], name)
    return _shipped(library.find("aircraft", name))


@cache
def _shipped(path: Path) -> AircraftType:
    return validated(AircraftType, documents.read(path), str(path))
