"""A short encounter of two airliners for runs of TCAS II."""

from __future__ import annotations

import json
from typing import Any

from airhilt import load
from airhilt.scenario import Scenario
from airhilt.world.loading import load_text


def meeting(**changes: Any) -> Scenario:
    """Return 75 s of a head-on encounter that begins just before the traffic advisory."""
    document = load("s02a_headon").model_dump(mode="json")
    for actor in document["actors"]:
        actor["initial"]["position"]["distance_nm"] = 7.5
    document |= {"duration_s": 75.0, "cameras": [], "perturbations": []} | changes
    return load_text(json.dumps(document), "meeting")
