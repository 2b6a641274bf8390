"""Reactions of people to what tells them to act: their delay, and whether and how they follow."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from airhilt.messages import Climb, Severity
from airhilt.scenario.models import (
    AircraftSpec,
    Channel,
    Channels,
    Reactions,
    Responses,
    Scenario,
    VehicleSpec,
)
from airhilt.sim.streams import stream

FOLLOWED_FROM = Severity.CAUTION
"""Least severity that people act on."""
REPEAT_FACTOR = 0.5
"""Reaction time to a changed advisory, as a part of the first reaction time: 2.5 s after 5 s in the
standard pilot model of ICAO Annex 10, volume IV."""

ResponseKind = Literal["prompt", "late", "weak", "opposite", "none"]
"""As told, in time; as told, late; too slowly up or down; up in place of down; not at all."""
MANNERS: Mapping[ResponseKind, str] = {
    "late": ", late",
    "weak": ", too slowly",
    "opposite": ", in the opposite sense",
}
"""Words for responses that are not as told."""


@dataclass(frozen=True, slots=True)
class Response:
    """Response of one person to what tells it to act.

    Attributes
    ----------
    delay_s
        Time from hearing or reading it to acting, in s.
    rate_factor
        Vertical rate that is flown, as a part of the one that was told.
    """

    kind: ResponseKind
    delay_s: float
    rate_factor: float = 1.0

    @property
    def follows(self) -> bool:
        """True if the person does anything."""
        return self.kind != "none"

    @property
    def is_opposite(self) -> bool:
        """True if the person climbs in place of descending, or the other way round."""
        return self.kind == "opposite"

    @property
    def manner(self) -> str:
        """Words after what is done, where it is not done as told; else empty."""
        return MANNERS.get(self.kind, "")

    def flown(self, told: Climb, altitude_ft: float) -> Climb:
        """Return the climb or descent that is flown from an altitude in place of the one told."""
        rate_fpm = told.vertical_rate_fpm * self.rate_factor
        if not self.is_opposite:
            return told.model_copy(update={"vertical_rate_fpm": rate_fpm})
        mirrored = {
            "sense": "descend" if told.sense == "climb" else "climb",
            "altitude_ft": 2.0 * altitude_ft - told.altitude_ft,
        }
        return told.model_copy(update=mirrored)


@dataclass(frozen=True, slots=True)
class ReactionModel:
    """Draws the responses of one crew, driver or controller from a seed (`response_seed`).

    Attributes
    ----------
    name
        Callsign, or name of the unit.
    channels
        Responses of its role, by channel.
    own
        Its own reaction time and compliance, as far as the scenario has them.
    """

    name: str
    channels: Channels
    own: Reactions
    seed: int

    def respond(
        self,
        channel: Channel,
        identity: str,
        *,
        revision: int = 0,
        is_repeated: bool = False,
        is_vertical: bool = False,
    ) -> Response:
        """Return the response to an advisory or a call.

        Whether and how somebody responds is the same for all revisions; the delay is not.

        Parameters
        ----------
        identity
            Id of the advisory or of the call.
        is_repeated
            True if an earlier revision is followed already, so that it takes less time.
        is_vertical
            True for a climb or descent, which may be too slow, or the wrong way.
        """
        responses = self._responses(channel)
        kind = self._kind(responses, channel, identity)
        if kind in ("weak", "opposite") and not is_vertical:
            kind = "prompt"
        draw = stream(self.seed, f"reaction/{self.name}/{identity}", revision).standard_normal()
        delay_s = responses.median_s * math.exp(responses.sigma * draw)
        delay_s *= REPEAT_FACTOR if is_repeated else 1.0
        delay_s *= responses.late_factor if kind == "late" else 1.0
        return Response(kind, delay_s, responses.rate_factor if kind == "weak" else 1.0)

    def _responses(self, channel: Channel) -> Responses:
        """Return the responses on a channel, with what the actor has of its own."""
        responses, own = self.channels.of(channel), self.own
        if own.compliance is not None:
            responses = responses.with_compliance(own.compliance)
        given = {"median_s": own.reaction_median_s, "sigma": own.reaction_sigma}
        return responses.model_copy(
            update={name: value for name, value in given.items() if value is not None}
        )

    def _kind(self, responses: Responses, channel: Channel, identity: str) -> ResponseKind:
        draw = stream(self.seed, f"response/{channel}/{self.name}/{identity}").random()
        shares: tuple[tuple[ResponseKind, float], ...] = (
            ("none", responses.no_response),
            ("late", responses.late),
            ("weak", responses.weak),
            ("opposite", responses.opposite),
        )
        total = 0.0
        for kind, share in shares:
            total += share
            if draw < total:
                return kind
        return "prompt"


def response_seed(scenario: Scenario, seed: int) -> int:
    """Return the seed of the responses in a run: one of its own for each scenario.

    Otherwise a crew that does not respond in one scenario would not in any with the same seed, and
    the runs of a sweep would be fewer than they seem.
    """
    return int(stream(seed, f"responses/{scenario.name}").integers(2**31))


def reaction_models(scenario: Scenario, seed: int) -> dict[str, ReactionModel]:
    """Return the reaction models of the crews and drivers of a scenario, by callsign."""
    model, seed = scenario.response_model, response_seed(scenario, seed)
    found = {}
    for spec in scenario.actors:
        match spec:
            case AircraftSpec(callsign=callsign, pilot=own):
                found[callsign] = ReactionModel(callsign, model.crews, own, seed)
            case VehicleSpec(callsign=callsign, driver=own):
                found[callsign] = ReactionModel(callsign, model.drivers, own, seed)
    return found


def controller_reactions(scenario: Scenario, unit: str, own: Reactions, seed: int) -> ReactionModel:
    """Return the reaction model of the controller of a unit."""
    channels = Channels(assistant=scenario.response_model.controllers)
    return ReactionModel(unit, channels, own, response_seed(scenario, seed))
