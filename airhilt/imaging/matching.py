"""Matching of detections with the actors in a picture.

A detection is about an actor if their boxes overlap by `OVERLAP`, or, where the actor is shorter
than `SMALL_PX` or thinner than `THIN_PX`, if the middle of the detection lies in the actor's box or
no more than `MARGIN_PX` beside it: there a pixel more or less decides on the overlap. Classes are
compared apart from that.
"""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.imaging.boxes import centre, overlap, size_px
from airhilt.messages import Box, Detection, SightingTruth

OVERLAP = 0.3
"""Intersection over union of two boxes that are about the same thing."""
SMALL_PX = 12.0
THIN_PX = 4.0
MARGIN_PX = 3.0


def matches(
    sightings: Sequence[SightingTruth], detections: Sequence[Detection]
) -> list[SightingTruth | None]:
    """Return what each detection is about, None for nothing; each actor is found once at most.

    Pairs of the same class are taken first; among those, the pairs that overlap most.
    """
    able = [
        (detection.label != sighting.label, -overlap(detection.box, sighting.box), d, s)
        for d, detection in enumerate(detections)
        for s, sighting in enumerate(sightings)
        if sighting.pixels > 0.0 and is_about(detection.box, sighting.box)
    ]
    found: list[SightingTruth | None] = [None] * len(detections)
    taken: set[int] = set()
    for _, _, d, s in sorted(able):
        if found[d] is None and s not in taken:
            found[d] = sightings[s]
            taken.add(s)
    return found


def is_about(box: Box, truth: Box) -> bool:
    """Return whether a box that was found can be that of a body, whatever its class."""
    if overlap(box, truth) >= OVERLAP:
        return True
    left, top, right, bottom = truth
    if size_px(truth) >= SMALL_PX and min(right - left, bottom - top) >= THIN_PX:
        return False
    x, y = centre(box)
    return left - MARGIN_PX <= x <= right + MARGIN_PX and top - MARGIN_PX <= y <= bottom + MARGIN_PX
