"""What `airhilt validate` says of scenarios, and of their dry flights."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from meetings import meeting

Cli = Callable[..., subprocess.CompletedProcess[str]]


def scenario_file(folder: Path, **changes: object) -> Path:
    path = folder / "meeting.json"
    path.write_text(meeting(**changes).model_dump_json())
    return path


MILE_APART = [
    {
        "path": "actors/*/initial/position/offset_nm",
        "distribution": {"type": "uniform", "limit": 1.0},
    }
]
NEVER = {
    "actors": ["AAL123", "DAL456"],
    "opens_when": {"type": "time", "at_s": 1.0},
    "unassisted": "collision",
}


def test_a_dry_flight_says_how_often_the_conflict_comes_about_and_how_near(
    airhilt_command: Cli, tmp_path: Path
) -> None:
    done = airhilt_command("validate", "--dry-fly", "2", scenario_file(tmp_path))
    assert done.returncode == 0
    assert "conflict (loss_of_separation) in 2 of 2 seeds" in done.stdout
    assert "closest approach min / median / max" in done.stdout
    assert "percentile" not in done.stdout
    assert "warning" not in done.stderr


def test_a_dry_flight_names_the_seeds_that_bring_about_no_conflict(
    airhilt_command: Cli, tmp_path: Path
) -> None:
    file = scenario_file(tmp_path, conflict=NEVER, perturbations=MILE_APART)
    done = airhilt_command("validate", "--dry-fly", "2", "--json", file)
    assert done.returncode == 1
    assert "no conflict as declared with 2 seeds of 2: 0, 1" in done.stderr
    (row,) = json.loads(done.stdout)
    flown = row["dry_flight"]
    assert (flown["seeds"], flown["came_about"], flown["declared"]) == (2, 0, "collision")
    first, second = (flight["closest_m"] for flight in flown["flights"])
    assert first != second
    spread = flown["closest_approach"]
    assert (spread["min_m"], spread["max_m"]) == (min(first, second), max(first, second))
    assert spread["p5_m"] is None


def test_a_unit_on_the_emergency_channel_is_warned_of(airhilt_command: Cli, tmp_path: Path) -> None:
    path = scenario_file(tmp_path)
    path.write_text(path.read_text().replace("134325", "121500"))
    done = airhilt_command("validate", path)
    assert done.returncode == 0
    assert "'Washington Center' works on 121500 kHz, which is for emergencies alone" in done.stderr


@pytest.mark.parametrize("seeds", ["0", "-1", "many"])
def test_the_number_of_seeds_is_one_or_more(airhilt_command: Cli, seeds: str) -> None:
    done = airhilt_command("validate", "--dry-fly", seeds, "s02c_nominal")
    assert done.returncode == 2
    assert "--dry-fly" in done.stderr
