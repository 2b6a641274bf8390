"""Versions in ``run.json``: those of packages that decide where things are and what is heard."""

from __future__ import annotations

import importlib.metadata

from airhilt.record.folder import versions


def test_the_packages_that_decide_places_and_headings_are_recorded() -> None:
    recorded = versions()
    for name in ("geographiclib", "shapely", "pygeomag", "jsbsim", "numpy"):
        assert recorded[name] == importlib.metadata.version(name)
