"""Predicted losses of separation in flight, from tracks and cleared levels."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple, get_args

from pydantic import Field, model_validator

from airhilt.assistant.decision.aerodrome import TrafficZone
from airhilt.assistant.decision.tracks import Track
from airhilt.configuration import Configuration, Seconds, require_order
from airhilt.geodesy.relative_motion import Minima, Relative, relative, time_to_loss_s
from airhilt.messages import Evidence, Severity
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS

SeparationRule = Literal["loss_of_separation", "level_readback"]
"""Rules that find conflicts in the air."""
SEPARATION_RULES: tuple[SeparationRule, ...] = get_args(SeparationRule)


class SeparationConfig(Configuration):
    """Rules and thresholds for conflicts in the air; the briefing has the separation minima.

    The look-ahead times follow those of ground-based short-term conflict alert, about two
    minutes (EUROCONTROL-GUID-159, edition 1.0), with an earlier ADVISORY and a later WARNING.
    """

    rules: tuple[SeparationRule, ...] = Field(
        SEPARATION_RULES,
        description="rules that are applied, by the names that evidence gives them",
    )
    vertical_tolerance_ft: float = Field(
        75.0,
        ge=0.0,
        le=500.0,
        description="allowance for level keeping, the 25 ft steps of ADS-B and the spread of its "
        "rate, in ft; chosen",
    )
    advisory_s: Seconds = Field(
        180.0, description="time to the loss from which it is an ADVISORY, in s; chosen"
    )
    caution_s: Seconds = Field(
        120.0, description="likewise for a CAUTION, in s; EUROCONTROL-GUID-159"
    )
    warning_s: Seconds = Field(60.0, description="likewise for a WARNING, in s; chosen")
    persistence_s: Seconds = Field(
        1.0, description="time for which a severity must hold before it is told, in s; chosen"
    )
    release_s: Seconds = Field(
        8.0, description="time for which a conflict must be over before that is told, in s; chosen"
    )
    hysteresis_m: float = Field(
        180.0,
        ge=0.0,
        le=5000.0,
        description="added to the horizontal minimum once a CAUTION was told, in m: the error of a "
        "velocity of 3 m/s (NACv 2 of DO-260B, 95 %) over 60 s",
    )
    stale_s: Seconds = Field(
        15.0,
        description="silence after which a track is dropped, in s: late reports are carried on to "
        "the present; chosen",
    )
    readback_window_s: Seconds = Field(
        30.0,
        description="a readback later than this after its clearance, in s, belongs to something "
        "else; chosen",
    )

    @model_validator(mode="after")
    def _in_order(self) -> SeparationConfig:
        require_order(self, "warning_s", "caution_s", "advisory_s")
        return self

    def severity_of(self, time_to_loss_s: float | None) -> Severity | None:
        """Return how severe a loss of separation is that is so far ahead; None if it is none."""
        if "loss_of_separation" not in self.rules:
            return None
        if time_to_loss_s is None or time_to_loss_s > self.advisory_s:
            return None
        if time_to_loss_s <= self.warning_s:
            return Severity.WARNING
        return Severity.CAUTION if time_to_loss_s <= self.caution_s else Severity.ADVISORY


class SeparationStandard(SeparationConfig):
    """The rules and thresholds with the separation minima of the briefing."""

    horizontal_m: float = 5.0 * NAUTICAL_MILE
    vertical_m: float = 1000.0 * FOOT

    @property
    def standard(self) -> Minima:
        """The separation minima."""
        return Minima(self.horizontal_m, self.vertical_m)

    @property
    def infringed(self) -> Minima:
        """The distances below which separation counts as lost."""
        return Minima(self.horizontal_m, self.vertical_m - self.vertical_tolerance_ft * FOOT)


class Prediction(NamedTuple):
    """The predicted encounter of two aircraft, as of now."""

    first: Track
    second: Track
    time_to_loss_s: float | None
    time_to_closest_approach_s: float
    horizontal_m: float
    """Horizontal distance at the closest approach, in m."""
    vertical_m: float
    is_over: bool
    """True if the two are past each other, or draw apart on paths that stay clear, or move so
    slowly against each other that no turn brings them together within the look-ahead."""

    @property
    def callsigns(self) -> tuple[str, str]:
        """Callsigns of the two."""
        return self.first.callsign, self.second.callsign

    @property
    def draws_apart(self) -> bool:
        """True if neither distance becomes less."""
        gap_m = self.first.altitude_m - self.second.altitude_m
        opening_m_s = self.first.profile().rate_m_s - self.second.profile().rate_m_s
        return self.time_to_closest_approach_s == 0.0 and gap_m * opening_m_s >= 0.0

    def evidence(self) -> Evidence:
        """Return the prediction as an advisory gives it."""
        heard = [track.radio_id for track in (self.first, self.second) if track.radio_id]
        return Evidence(
            sources=("adsb", "radio") if heard else ("adsb",),
            radio_ids=tuple(heard),
            tracks=(self.first.icao24, self.second.icao24),
            rules=("loss_of_separation",),
            shares={} if heard else {"adsb": 1.0},
            time_to_loss_s=self.time_to_loss_s,
            time_to_closest_approach_s=self.time_to_closest_approach_s,
            horizontal_at_closest_approach_m=self.horizontal_m,
            vertical_at_closest_approach_m=self.vertical_m,
        )


def predict(
    first: Track,
    second: Track,
    config: SeparationStandard,
    zone: TrafficZone | None,
    is_on_ground: bool,
    is_told: bool,
) -> Prediction:
    """Return the predicted encounter of two aircraft.

    Parameters
    ----------
    zone
        Airspace in which a tower keeps aircraft apart by sight.
    is_on_ground
        True if either is on the ground by its last report.
    is_told
        True if a CAUTION about the two has been told: they must then pass with hysteresis.
    """
    motion = relative(first, second)
    profiles = (first.profile(), second.profile())
    infringed = config.infringed
    if is_told:
        infringed = Minima(infringed.horizontal_m + config.hysteresis_m, infringed.vertical_m)
    interval = motion.interval_within(infringed.horizontal_m)
    is_near = interval is not None and interval[1] > 0.0 and interval[0] <= config.advisory_s
    loss_s = time_to_loss_s(motion, *profiles, infringed) if is_near else None
    is_over = _is_over(motion, config)
    if is_on_ground or _is_towers(first, second, loss_s, zone):
        is_over, loss_s = True, None
    approach_s = max(motion.time_to_closest_approach_s(), 0.0)
    return Prediction(
        first,
        second,
        loss_s,
        approach_s,
        motion.at(approach_s).distance_m,
        abs(profiles[0].at(approach_s) - profiles[1].at(approach_s)),
        is_over,
    )


def _is_over(motion: Relative, config: SeparationStandard) -> bool:
    """Return whether two will not come within the horizontal minimum, even if one turns again."""
    interval = motion.interval_within(config.horizontal_m)
    if interval is not None:
        return interval[1] <= 0.0
    if motion.time_to_closest_approach_s() <= 0.0:
        return True
    speed_m_s = math.hypot(motion.velocity_north_m_s, motion.velocity_east_m_s)
    return motion.distance_m - speed_m_s * config.advisory_s > config.horizontal_m


def _is_towers(first: Track, second: Track, loss_s: float | None, zone: TrafficZone | None) -> bool:
    """Return whether a tower keeps two apart, now or when they would lose separation."""
    if zone is None:
        return False
    if zone.contains(first) and zone.contains(second):
        return True
    if loss_s is None:
        return False
    then_ns = first.t_ns + round(loss_s * SECOND_NS)
    return zone.contains(first.at(then_ns)) and zone.contains(second.at(then_ns))
