"""Comparisons of sweeps, assistants and runs: what is paired, and what cannot be."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from click.testing import CliRunner

from airhilt.cli.main import cli
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError
from airhilt.options import Options
from airhilt.report.comparison import compare
from airhilt.report.comparison.page import write_comparison
from airhilt.report.comparison.runs import RunComparison
from airhilt.report.comparison.sweeps import SweepComparison
from airhilt.scenario import Scenario
from sweep_tables import Row, sweep_row, write_sweep

HOSTILE = "</script><script>alert(1)</script>"


def rows(assistant: str, seeds: range, **given: Any) -> list[Row]:
    return [sweep_row("s01a_x", assistant, seed, **given) for seed in seeds]


def sweeps(first: Path, second: Path | None = None, **given: Any) -> SweepComparison:
    found = compare(first, second, **given)
    assert isinstance(found, SweepComparison)
    return found


def found_of(comparison: SweepComparison, measure: str) -> Any:
    (differences,) = comparison.families.values()
    return next(each for each in differences if each.measure.name == measure)


def test_two_assistants_are_paired_by_scenario_seed_and_parameters(tmp_path: Path) -> None:
    folder = write_sweep(
        tmp_path / "s",
        [
            *rows("paper", range(4), snr_db=0.0, avoided=False, time_to_first_warning_s=9.0),
            *rows("reference", range(1, 6), snr_db=0.0, avoided=True, time_to_first_warning_s=7.0),
            *rows("reference", range(4), snr_db=20.0, avoided=False),
        ],
    )
    found = sweeps(folder, assistants=("paper", "reference"))
    assert found.paired_by == ("scenario", "seed", "snr_db")
    assert found.differing == {"assistant": ("paper", "reference")}
    assert (found.pairs, found.without_partner) == (3, (1, 6))
    avoided = found_of(found, "avoided")
    assert avoided.difference.value == 100.0
    assert (avoided.test.only_first, avoided.test.only_second) == (0, 3)
    assert avoided.test.p_value == pytest.approx(0.25)
    assert found_of(found, "time_to_first_warning").difference.value == -2.0


def test_pairs_of_one_scenario_are_a_cluster_however_many_seeds_they_have(tmp_path: Path) -> None:
    """Seven scenarios, of which the second assistant saves five, whatever the seed."""
    widths = []
    for seeds in (1, 6):
        table = [
            sweep_row(f"s01a_{name}", assistant, seed,
                      avoided=assistant == "reference" and name < 5)
            for name in range(7)
            for assistant in ("paper", "reference")
            for seed in range(seeds)
        ]  # fmt: skip
        folder = write_sweep(tmp_path / f"{seeds}", table)
        found = sweeps(folder, assistants=("paper", "reference"))
        assert (found.pairs, found.clusters) == (7 * seeds, 7)
        difference = found_of(found, "avoided").difference
        widths.append(difference.high - difference.low)
        assert found_of(found, "avoided").test.p_value == pytest.approx(2 / 2**5)
    assert widths[1] >= widths[0]


def test_a_pair_in_which_one_has_no_value_is_left_out_and_counted(tmp_path: Path) -> None:
    one = rows("paper", range(3), time_to_first_warning_s=9.0)
    other = rows("reference", range(3), time_to_first_warning_s=8.0)
    del other[0]["time_to_first_warning_s"]
    folder = write_sweep(tmp_path / "s", [*one, *other])
    found = found_of(sweeps(folder, assistants=("paper", "reference")), "time_to_first_warning")
    assert (found.difference.n, found.one_sided, found.first.n) == (2, 1, 2)


def test_runs_that_leave_a_parameter_to_the_scenario_are_paired_too(tmp_path: Path) -> None:
    given = [*rows("paper", range(2), snr_db=None), *rows("paper", range(2), snr_db=0.0)]
    first = write_sweep(tmp_path / "a", given)
    assert sweeps(first, write_sweep(tmp_path / "b", given)).pairs == 4


def test_a_parameter_that_only_one_sweep_leaves_to_the_scenario_is_no_partner_by_force(
    tmp_path: Path,
) -> None:
    given = [*rows("paper", range(2), snr_db=5.0), *rows("paper", range(2), snr_db=10.0)]
    first = write_sweep(tmp_path / "a", given)
    second = write_sweep(tmp_path / "b", rows("paper", range(2), snr_db=None))
    table = pq.read_table(second / "sweep.parquet")
    of_nulls = pa.array([None, None], pa.string())
    place = table.column_names.index("snr_db")
    pq.write_table(table.set_column(place, "snr_db", of_nulls), second / "sweep.parquet")
    with pytest.raises(AirhiltError, match="no run of the one has a partner"):
        compare(first, second)


def test_two_sweeps_with_a_latency_each_differ_in_it(tmp_path: Path) -> None:
    first = write_sweep(tmp_path / "a", rows("paper", range(3), latency="fixed"))
    found = sweeps(first, write_sweep(tmp_path / "b", rows("paper", range(3), latency="paper")))
    assert found.differing == {"latency": ("fixed", "paper")}
    assert found.paired_by == ("scenario", "seed", "assistant")


def test_runs_that_would_share_a_partner_are_refused(tmp_path: Path) -> None:
    several = [row for snr in (0.0, 10.0) for row in rows("paper", range(2), snr_db=snr)]
    first = write_sweep(tmp_path / "several", several)
    second = write_sweep(tmp_path / "b", rows("paper", range(2)))
    with pytest.raises(AirhiltError, match="several runs would have the same partner in b: they "
                       "differ in snr_db"):  # fmt: skip
        compare(first, second)


@pytest.mark.parametrize(
    ("names", "message"),
    [(("paper", "refrence"), "no runs of assistant 'refrence'"),
     (("paper", "paper"), "expected two different ones")],
)  # fmt: skip
def test_assistants_that_cannot_be_compared_are_named(
    tmp_path: Path, names: tuple[str, str], message: str
) -> None:
    folder = write_sweep(tmp_path / "s", [*rows("paper", range(2)), *rows("reference", range(2))])
    with pytest.raises(AirhiltError, match=message):
        compare(folder, None, names)


def test_a_run_and_a_sweep_are_no_pair(tmp_path: Path, two_runs: tuple[Path, Path]) -> None:
    folder = write_sweep(tmp_path / "s", rows("paper", range(2)))
    with pytest.raises(AirhiltError, match="one is a sweep and the other a run"):
        compare(folder, two_runs[0])
    with pytest.raises(AirhiltError, match="neither a run nor a sweep"):
        compare(folder, tmp_path)
    with pytest.raises(AirhiltError, match="expected a second folder"):
        compare(folder)


@pytest.fixture(scope="module")
def two_runs(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A run with an assistant, and one without."""
    out = tmp_path_factory.mktemp("runs")
    warned, alone = (
        run(
            encounter, Options(latency="fixed", assistant=name, speech=False, out=out / name)
        ).folder
        for name in ("reference", "none")
    )
    return warned, alone


def of_runs(first: Path, second: Path) -> RunComparison:
    found = compare(first, second)
    assert isinstance(found, RunComparison)
    return found


def test_two_runs_differ_in_what_was_asked_for_and_in_what_came_of_it(
    two_runs: tuple[Path, Path],
) -> None:
    found = of_runs(*two_runs)
    assert found.settings["assistant"] == ("reference", "none")
    differing = {each.name: each for each in found.metrics}
    assert (differing["warned"].first, differing["warned"].second) == (True, False)
    assert differing["advisories"].difference < 0
    assert found.parted_s is not None
    assert found.events[0][0] != found.events[1][0]


def test_a_run_is_the_same_as_its_copy(two_runs: tuple[Path, Path], tmp_path: Path) -> None:
    found = of_runs(two_runs[0], shutil.copytree(two_runs[0], tmp_path / "copy"))
    assert found.settings == {}
    assert [each.name for each in found.metrics] == []
    assert found.parted_s is None


def test_a_page_of_hostile_names_has_no_markup_of_theirs(tmp_path: Path) -> None:
    folder = write_sweep(tmp_path / "s", [*rows("paper", range(3), avoided=True),
                                          *rows(HOSTILE, range(3), avoided=False)])  # fmt: skip
    page = write_comparison(compare(folder, None, ("paper", HOSTILE)), tmp_path / "page.html")
    text = page.read_text()
    assert "<script>alert" not in text
    assert "default-src 'none'" in text


def test_the_command_prints_tables_json_and_a_page(tmp_path: Path) -> None:
    folder = write_sweep(tmp_path / "s", [*rows("paper", range(3), avoided=True),
                                          *rows("none", range(3), avoided=False)])  # fmt: skip
    given = ["compare", str(folder), "--assistants", "paper,none"]
    printed = CliRunner().invoke(cli, given, catch_exceptions=False)
    assert "3 pairs by scenario, seed" in printed.stdout
    page = tmp_path / "page.html"
    asked = CliRunner().invoke(cli, [*given, "--json", "--out", str(page)], catch_exceptions=False)
    assert json.loads(asked.stdout)["pairs"] == 3
    assert page.is_file()
    refused = CliRunner().invoke(cli, ["compare", str(folder), "--assistants", "paper"])
    assert refused.exit_code == 2
