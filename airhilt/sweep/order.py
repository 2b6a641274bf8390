"""The order in which runs are given to workers."""

from __future__ import annotations

import json
from collections.abc import Sequence
from itertools import zip_longest

from airhilt.sensors.cameras import UNSEEN_FIELDS
from airhilt.sweep.outcome import Request

SEEN_OPTIONS = ("seed", "visibility_m")
"""Options that cameras see, besides those that all runs of a sweep have in common."""


def apart(requests: Sequence[Request], workers: int) -> list[Request]:
    """Return runs in an order in which no two workers draw the same pictures at once.

    The first of the runs that share pictures draws them. A second one at the same time would draw
    them too. So each worker begins with other pictures, and runs that share follow one another.
    """
    sharing: dict[str, list[Request]] = {}
    for request in requests:
        sharing.setdefault(_pictures_of(request), []).append(request)
    groups = list(sharing.values())
    return [
        request
        for first in range(0, len(groups), workers)
        for abreast in zip_longest(*groups[first : first + workers])
        for request in abreast
        if request is not None
    ]


def _pictures_of(request: Request) -> str:
    """Return what is the same for runs that share pictures, and for no others."""
    if not request.options.get("share_pictures"):
        return request.key
    scenario = {
        name: value for name, value in request.scenario.items() if name not in UNSEEN_FIELDS
    }
    options = [request.options.get(name) for name in SEEN_OPTIONS]
    return json.dumps([scenario, options], sort_keys=True)
