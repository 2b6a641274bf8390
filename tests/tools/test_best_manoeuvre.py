"""What the best manoeuvre could keep of separation, by when it begins."""

from __future__ import annotations

import itertools
from pathlib import Path

import airhilt
from airhilt.world.loading import load
from best_manoeuvre import best_manoeuvres


def test_who_acts_7_and_a_half_seconds_after_the_mayday_cannot_keep_separation(
    tmp_path: Path,
) -> None:
    folder = airhilt.run(
        load("s02b_emergency_descent"), out=tmp_path / "run", assistant="none", latency="fixed",
        speech=False, cameras=False,
    ).folder  # fmt: skip
    found = best_manoeuvres(folder, "UAL9", "AAL123", known_at_s=24.9)
    for sooner, later in itertools.pairwise(found):
        assert later.separation <= sooner.separation
    kept = {each.delay_s: each.separation for each in found}
    assert kept[0.0] > 1.0 > kept[7.5]
