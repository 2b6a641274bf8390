"""Runway overlaps as the AIRHILT paper ran them, and its numbers beside ours.

The paper (arXiv 2511.18718) reports 10 runs a variant, with the noise of the radio and the
visibility drawn anew in each: that is what the perturbations of the scenarios of S01A do.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from airhilt.cosim.latency_presets import ASR_S, TTS_S, VISION_S
from airhilt.engine_families import NONE
from airhilt.sweep.evaluation import ranking
from airhilt.sweep.evaluation.assistants import Assistant, shipped_scenarios
from airhilt.sweep.evaluation.preset import Choice, Preset, Results, Row
from airhilt.sweep.evaluation.scores import (
    broken_off,
    mean,
    mean_over,
    median,
    per_hour,
    share,
    values,
)
from airhilt.sweep.evaluation.tables import NOTHING, Cell, Table, number
from airhilt.sweep.evaluation.tables import share as share_cell
from airhilt.sweep.specification import Specification

FAMILY = "S01A"
PAPER = Assistant("paper")
TIME_TO_FIRST_WARNING_S = 7.66
"""Mean time to first warning of the paper, in s."""
FIRST_DETECTION_M = 125.0
"""Range of the first detection in the paper, about, in m."""
GIVEN = "given by --latency"
PARTS = ("speech", "recognition", "evidence", "decision", "voice")
"""Parts of the time to first warning (docs/first-warning.md)."""
COSTS = ("broken off", "advisories, 1/h")


def specifications(choice: Choice) -> Mapping[str, Specification]:
    """Return the sweeps of the ranking of the paper's assistant: all variants with a conflict."""
    return ranking.sweeps(choice, [PAPER], variants(), {"latency": "paper"})


def variants() -> list[str]:
    """Return the names of the scenarios of the family that have a conflict."""
    scenarios = shipped_scenarios().items()
    return [name for name, one in scenarios if one.family == FAMILY and one.conflict]


def tables(results: Results) -> Sequence[Table]:
    """Return the comparison with the paper, the times of each variant, and the ranking."""
    rows = results.rows[PAPER.name]
    ranked = ranking.table(ranking.tried(results.rows), results.rows[NONE])
    return _comparison(rows, results.choice), _variants(rows), ranked


def _comparison(rows: Sequence[Row], choice: Choice) -> Table:
    by_call = [row for row in rows if _rests_on_the_call_alone(row)]
    warning = "time_to_first_warning_s"
    return Table(
        name="comparison",
        title="The paper's numbers, and those of AIRHILT",
        columns=("number", "the paper", "mean", "median", "runs", "origin"),
        rows=(
            _compared("time to first warning, s", TIME_TO_FIRST_WARNING_S, rows, warning, "result"),
            _compared(
                "the same, where it rests on the call that begins the conflict alone, s",
                TIME_TO_FIRST_WARNING_S,
                by_call,
                warning,
                "result",
            ),
            _compared(
                "the same, from the opening of the conflict window on, s",
                TIME_TO_FIRST_WARNING_S,
                rows,
                "time_to_first_warning_after_window_s",
                "result",
            ),
            _compared("ASR latency, s", ASR_S, rows, "latencies_asr_p50_s", GIVEN),
            _compared("vision latency, s", VISION_S, rows, "latencies_vision_p50_s", GIVEN),
            _compared(
                "TTS latency of the first warning, s",
                TTS_S,
                rows,
                "first_warning_parts_voice_s",
                GIVEN,
            ),
            _compared(
                "range of the first detection, m",
                FIRST_DETECTION_M,
                rows,
                "first_detection_range_m",
                "result",
            ),
        ),
        notes=tuple(_notes(choice)),
    )


def _rests_on_the_call_alone(row: Row) -> bool:
    """Return true if the warning waited for one call of the conflict, and for nothing else."""
    return bool(row["first_warning_parts_evidence_s"] == 0.0)


def _compared(
    what: str, paper: float, rows: Sequence[Row], column: str, origin: str
) -> tuple[Cell, ...]:
    runs = len(values(rows, column))
    digits = 0 if column.endswith("_m") else 2
    return (
        what,
        f"{paper:g}",
        number(mean(rows, column), digits),
        number(median(rows, column), digits),
        runs,
        origin if runs else "not measured",
    )


def _notes(choice: Choice) -> Iterator[str]:
    yield (
        "In brackets: 95 % interval over the variants, or over the seeds of one. ASR and vision "
        "latency: the median of each run. Latencies of stages are no results: the latency source "
        "draws them."
    )
    if not choice.has_cameras:
        yield "Without cameras: vision and the first detection were not run."


def _variants(rows: Sequence[Row]) -> Table:
    groups = {name: [row for row in rows if row["scenario"] == name] for name in _names(rows)}
    return Table(
        name="variants",
        title="Time to first warning by variant, in s",
        columns=("variant", "warned", "mean", "median", "before", *PARTS, "avoided", *COSTS),
        rows=tuple(_variant(name, own) for name, own in {**groups, "all": rows}.items()),
        notes=(
            "Before: share of the warnings that came before the conflict began. The five parts are "
            "means. Avoided: of the runs in which somebody was warned, or the pair came to harm. "
            "Broken off: go-arounds and rejected take-offs per run.",
        ),
    )


def _names(rows: Sequence[Row]) -> list[str]:
    return sorted({row["scenario"] for row in rows})


def _variant(name: str, rows: Sequence[Row]) -> tuple[Cell, ...]:
    column = "time_to_first_warning_s"
    warned = [row for row in rows if row["t_first_warning_s"] is not None]
    early = sum(_is_before(row) for row in warned)
    return (
        name,
        f"{len(warned)} of {len(rows)}",
        number(mean(rows, column), 2),
        number(median(rows, column), 2),
        f"{100.0 * early / len(warned):.0f} %" if warned else NOTHING,
        *(_plain(rows, f"first_warning_parts_{part}_s") for part in PARTS),
        share_cell(share(rows, "avoided")),
        number(mean_over(rows, broken_off), 2),
        number(per_hour(rows, "advisories")),
    )


def _is_before(row: Row) -> bool:
    """Return true for a warning before the begin, also of a conflict that then never began."""
    time_s = row["time_to_first_warning_s"]
    return time_s is None or bool(time_s < 0.0)


def _plain(rows: Sequence[Row], column: str) -> Cell:
    found: Sequence[float] = values(rows, column)
    return f"{sum(found) / len(found):.2f}" if found else NOTHING


PRESET = Preset(
    name="paper",
    summary="S01A as the AIRHILT paper ran it, with its numbers beside ours",
    seeds=10,
    specifications=specifications,
    tables=tables,
)
