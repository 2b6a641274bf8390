"""Models of a scenario file: the schema only. Unknown fields are refused everywhere."""

from airhilt.scenario.models.actors import (
    ActorSpec,
    Airborne,
    AircraftAction,
    AircraftSpec,
    AircraftStart,
    GroundStart,
    HoldingShort,
    LinedUp,
    OnFinal,
    PlannedAction,
    Reactions,
    Standing,
    Transponder,
    VehicleSpec,
    WildlifeSpec,
)
from airhilt.scenario.models.base import Callsign, Identifier
from airhilt.scenario.models.conditions import (
    AirspeedReached,
    AllOf,
    AltitudeReached,
    AnyOf,
    BoundForAltitude,
    BoundForRunway,
    ClosestApproachPassed,
    Collided,
    Condition,
    DistanceBelow,
    FixPassed,
    HeightAbove,
    HeightBelow,
    InPhase,
    LineBegun,
    LineEnded,
    OffRunways,
    OnLeg,
    OnRunway,
    Pair,
    PredictedLossOfSeparation,
    SeparationBelow,
    SpeedAbove,
    ThresholdWithin,
    TimeReached,
    TrackReached,
)
from airhilt.scenario.models.controllers import Alerting, Controller
from airhilt.scenario.models.failures import (
    Blocked,
    CallsignConfused,
    Delayed,
    Dropped,
    EngineFailure,
    Failure,
    Ignored,
    NotReceived,
    ReadbackWrong,
    StuckMicrophone,
)
from airhilt.scenario.models.radio import Radio, RadioLine, ScriptedCommand, StationRadio, Topology
from airhilt.scenario.models.responses import (
    RESPONSE_MODELS,
    Channel,
    Channels,
    ResponseModel,
    ResponseModelName,
    Responses,
)
from airhilt.scenario.models.scenario import (
    Conflict,
    Normal,
    Perturbation,
    Scenario,
    Separation,
    UnassistedOutcome,
    Uniform,
)
from airhilt.scenario.models.scene import (
    AirportScene,
    Daylight,
    EnRouteScene,
    Scene,
    Turbulence,
    Visibility,
    Weather,
    Wind,
)
from airhilt.scenario.models.sensors import (
    ActorMount,
    Adsb,
    AdsbReceiver,
    Camera,
    CameraName,
    FixedMount,
    Radar,
    SurfaceSurveillance,
)
