"""Occupants of a runway, by cameras and by ADS-B."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from airhilt.assistant.decision.aerodrome import Strip, Vector
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.threats import UNIDENTIFIED, WILDLIFE
from airhilt.assistant.decision.visual_tracks import (
    VisualTrack,
    VisualTracks,
    belief_in,
)


class Occupant(NamedTuple):
    """Somebody or something on a runway.

    Attributes
    ----------
    callsign
        Its callsign by ADS-B; None if only cameras show it.
    label
        Word for what it is, where it has no callsign.
    is_animal
        True if it is an animal.
    belief
        Belief of the cameras that it is on the runway, from 0 to 1.
    is_certain
        True if it counts as being there: by ADS-B, or because enough cameras agree, or one has
        shown it for long enough.
    tracks
        Visual tracks that show it.
    """

    callsign: str | None
    label: str
    is_animal: bool
    point: Vector
    belief: float
    is_certain: bool
    tracks: tuple[VisualTrack, ...]

    @property
    def name(self) -> str:
        """Its callsign, else a word for what has none."""
        return self.callsign or (WILDLIFE if self.is_animal else UNIDENTIFIED)


def occupants(
    situation: RunwaySituation, strip: Strip, visual_tracks: VisualTracks
) -> Iterator[Occupant]:
    """Yield who or what is on a runway.

    An aircraft or vehicle on the ground is on the runway by its ADS-B position; the belief of the
    cameras is that of the pictures which show it there. All else has the position that the pictures
    give.
    """
    for obstacle in situation.obstacles(strip):
        mobile = obstacle.mobile
        if obstacle.is_inside:
            shown = tuple(t for t in visual_tracks if t.explained_by == mobile.callsign)
            yield Occupant(mobile.callsign, "", False, mobile.point, belief_in(shown), True, shown)
    for seen in situation.seen(strip):
        thing = seen.thing
        yield Occupant(
            None,
            str(thing.label),
            thing.is_animal,
            thing.fix.point,
            seen.weight,
            seen.is_certain,
            thing.tracks,
        )
