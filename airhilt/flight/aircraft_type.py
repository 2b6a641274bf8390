"""The ``aircraft/*.json`` files: what a type of aircraft is, and the gains that fly it."""

from __future__ import annotations

from typing import Literal

import pydantic
from pydantic import Field

from airhilt import library
from airhilt.errors import ScenarioError


class _Section(pydantic.BaseModel):
    model_config = pydantic.ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Dimensions(_Section):
    """Size of the real aircraft, and where the JSBSim model's wheels are."""

    length_m: float = Field(gt=0)
    span_m: float = Field(gt=0)
    height_m: float = Field(gt=0)
    wheel_height_offset_m: float = Field(ge=0)
    """Of JSBSim's reference point above the ground when the model stands on its wheels."""


class Speeds(_Section):
    """Calibrated airspeeds in knots, and the limits that guidance keeps."""

    approach_kt: float = Field(gt=0)
    rotate_kt: float = Field(gt=0)
    climb_safety_kt: float = Field(gt=0)
    """V2."""
    cruise_kt: float = Field(gt=0)
    minimum_clean_kt: float = Field(gt=0)
    maximum_kt: float = Field(gt=0)
    """Vmo, or Vno for a piston aircraft."""
    maximum_mach: float = Field(gt=0)
    service_ceiling_ft: float = Field(gt=0)
    climb_rate_fpm: float = Field(gt=0)
    """Of a climb or descent for which no rate was asked."""
    maximum_climb_rate_fpm: float = Field(gt=0)
    maximum_descent_rate_fpm: float = Field(gt=0)


class PitchGains(_Section):
    """Attitude to pitch rate to elevator (normalised, -1..1).

    The elevator works against dynamic pressure: its gains hold at ``reference_pressure_pa``.
    """

    attitude_per_s: float = Field(gt=0)
    rate_limit_deg_s: float = Field(gt=0)
    rate_s: float = Field(ge=0)
    rate_integral: float = Field(ge=0)
    zero_lift_angle_deg: float
    """Angle of attack without lift, flaps up."""
    reference_pressure_pa: float = Field(gt=0)


class RollGains(_Section):
    """Bank to roll rate to aileron (normalised, -1..1)."""

    bank_limit_deg: float = Field(gt=0, le=45)
    bank_rate_limit_deg_s: float = Field(gt=0)
    bank_per_s: float = Field(gt=0)
    rate_s: float = Field(ge=0)
    rate_integral: float = Field(ge=0)


class YawGains(_Section):
    """Sideslip and yaw rate (against that of a coordinated turn) to rudder (normalised, -1..1)."""

    sideslip: float = Field(ge=0)
    sideslip_integral_per_s: float = Field(ge=0)
    rate_s: float = Field(ge=0)


class ThrustGains(_Section):
    """Airspeed to throttle lever (0..1)."""

    speed_s_m: float = Field(ge=0)
    speed_integral_m: float = Field(ge=0)
    acceleration_s2_m: float = Field(ge=0)
    climb_angle: float = Field(ge=0)
    lever_rate_per_s: float = Field(gt=0)


class GuidanceGains(_Section):
    """Course error to turn rate, altitude error to vertical rate."""

    course_per_s: float = Field(gt=0)
    altitude_per_s: float = Field(gt=0)


class Gains(_Section):
    """All control gains of a type; angles in radians where a gain multiplies one."""

    pitch: PitchGains
    roll: RollGains
    yaw: YawGains
    thrust: ThrustGains
    guidance: GuidanceGains


class Mesh(_Section):
    """Free shape parameters for a lofted model; what is not here follows from `Dimensions`."""

    fuselage_diameter_m: float = Field(gt=0)
    wing_sweep_deg: float
    """Of the quarter-chord line."""
    wing_root_chord_m: float = Field(gt=0)
    wing_tip_chord_m: float = Field(gt=0)
    wing_position: Literal["low", "high"]
    tail_span_m: float = Field(gt=0)
    fin_height_m: float = Field(gt=0)
    engines_m: tuple[tuple[float, float, float], ...]
    """Front of each engine: aft of the nose, right of the centre line, above the fuselage axis."""


class AircraftType(_Section):
    """One ``aircraft/*.json``."""

    name: str
    jsbsim_model: str
    """Folder of the model in the JSBSim wheel."""
    icao_designator: str = Field(pattern=r"^[A-Z][A-Z0-9]{1,3}$")
    """ICAO Doc 8643."""
    description: str
    category: Literal["jet", "heavy_jet", "piston_single", "piston_twin"]
    dimensions: Dimensions
    speeds: Speeds
    start: Literal["trim", "settle"]
    """How the model finds its equilibrium: JSBSim's trim, or flying until it is steady."""
    gains: Gains
    mesh: Mesh


def load_aircraft_type(name: str) -> AircraftType:
    """Read the aircraft type of that name.

    Raises
    ------
    ScenarioError
        There is none, or its file is wrong: the message names the file, the place in it and
        what was expected.
    """
    path = library.find("aircraft", name)
    try:
        return AircraftType.model_validate_json(path.read_bytes())
    except pydantic.ValidationError as error:
        problems = (
            f"  {'.'.join(str(part) for part in problem['loc']) or 'the file'}: {problem['msg']}"
            for problem in error.errors(include_url=False)
        )
        raise ScenarioError("\n".join([f"{path} is not an aircraft type:", *problems])) from error
