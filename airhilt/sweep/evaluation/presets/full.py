"""All families: assistants, modalities alone and left out, topologies, response models."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product

from airhilt.engine_families import NONE
from airhilt.sweep.evaluation import ranking, scores
from airhilt.sweep.evaluation.assistants import ASSISTANTS, REFERENCE, shipped_scenarios
from airhilt.sweep.evaluation.costs import EVERY_COST, NOTE, costs
from airhilt.sweep.evaluation.harms import harms_table
from airhilt.sweep.evaluation.preset import Choice, Preset, Results, Row
from airhilt.sweep.evaluation.scores import Baselines
from airhilt.sweep.evaluation.tables import Cell, Table, number, percent, share
from airhilt.sweep.specification import Specification

MODALITIES = "modalities"
VISION_ALONE = "vision_alone"
TOPOLOGIES = "topologies"
CREWS = "crews"
WITH_VISION = {
    "asr+vision": "without ADS-B",
    "adsb+vision": "without ASR",
    "adsb+asr": "without vision",
    "adsb": "ADS-B alone",
    "asr": "ASR alone",
    "vision": "vision alone",
}
"""Modalities that the assistant is given, as the tables name them."""
WITHOUT_CAMERAS = {"asr": "ASR alone (without ADS-B)", "adsb": "ADS-B alone (without ASR)"}
FUSION = ("asr_first", "gated_fusion")
"""Topologies besides that of the scenarios, which is ``parallel``."""
BESIDE = ("ideal", "observed")
"""Response models besides that of the scenarios, which is ``icao``."""
EVERYTHING = "all"
"""Name of the rows over all families."""
SCORES = ("warned", "in time", "missed", "avoided", "lead, s", "nuisance, 1/h")
MARGINS = ("over TCAS TA, s", "over TCAS RA, s", "over well clear, s")


def specifications(choice: Choice) -> Mapping[str, Specification]:
    """Return the sweeps of the ranking, and those of ablation and topologies."""
    scenarios = shipped_scenarios()
    names = list(scenarios)
    found = ranking.sweeps(choice, ASSISTANTS, names, {"latency": "fixed"})
    reference = {"latency": "fixed", "assistant": REFERENCE.name}
    given = [each for each in _given(choice) if each != "vision"]
    found[MODALITIES] = choice.specification(names, reference, {"modalities": given})
    if choice.has_cameras:
        with_cameras = [name for name, one in scenarios.items() if one.cameras]
        alone = {"modalities": ["vision"]}
        found[VISION_ALONE] = choice.specification(with_cameras, reference, alone)
    if choice.has_speech:
        found[TOPOLOGIES] = choice.specification(names, reference, {"topology": FUSION})
    if CREWS not in choice.options:
        found[CREWS] = choice.specification(names, reference, {CREWS: BESIDE})
    return found


def _given(choice: Choice) -> Mapping[str, str]:
    return WITH_VISION if choice.has_cameras else WITHOUT_CAMERAS


def tables(results: Results) -> Sequence[Table]:
    """Return the tables: ranking, families, costs, harms, severities, modalities and others."""
    rows = results.rows
    baselines = Baselines.of(rows[NONE], rows["well_clear"])
    makers = [_families, _costs, _harms, _severities, _modalities]
    if TOPOLOGIES in rows:
        makers.append(_topologies)
    if CREWS in rows:
        makers.append(_crews)
    ranked = ranking.table(ranking.tried(rows), rows[NONE])
    return ranked, *(make(results, baselines) for make in makers)


def _families(results: Results, baselines: Baselines) -> Table:
    compared = {each.name: results.rows[each.name] for each in ASSISTANTS}
    rows = [
        (family, name, *_scores(own, baselines), *_margins(own, baselines))
        for family, name in product(_names(results), compared)
        if (own := _of_family(compared[name], family))
    ]
    return Table(
        name="families",
        title="Assistants by family",
        columns=("family", "assistant", *SCORES, *MARGINS),
        rows=tuple(rows),
        notes=tuple(_notes(results)),
    )


def _costs(results: Results, baselines: Baselines) -> Table:
    rows = [
        (family, each.name, *costs(own, baselines, EVERY_COST))
        for family, each in product(_names(results), ASSISTANTS)
        if (own := _of_family(results.rows[each.name], family))
    ]
    return Table(
        name="costs",
        title="What it costs people",
        columns=("family", "assistant", *EVERY_COST),
        rows=tuple(rows),
        notes=(NOTE,),
    )


def _notes(results: Results) -> Iterator[str]:
    yield (
        "In brackets: 95 % interval over the scenarios, or over the seeds of one scenario. "
        "Avoided: no harm to the pair, of the runs in which it came to harm without an "
        "assistant. "
        "Nuisance: alerts in an hour of nominal traffic. A family that an assistant is not listed "
        "in does not apply to it: it is not made for it, or has nothing to read of the pair."
    )
    scenarios = shipped_scenarios()
    for each in ASSISTANTS:
        left_out = [
            name
            for name, one in scenarios.items()
            if not each.applies_to(one)
            and any(row["family"] == one.family for row in results.rows[each.name])
        ]
        if left_out:
            yield f"`{each.name}` does not apply to {', '.join(f'`{name}`' for name in left_out)}."
    if not results.choice.has_cameras:
        yield (
            "Without cameras: who has no transponder (S01C, S02C, `s01b_dropped_hold`) is known by "
            "radio calls alone, if at all."
        )


def _harms(results: Results, baselines: Baselines) -> Table:
    """Return what became, by scenario, of the runs with harm to the pair without an assistant."""
    names = (NONE, *(each.name for each in ASSISTANTS))
    return harms_table({name: results.rows[name] for name in names}, baselines)


def _severities(results: Results, baselines: Baselines) -> Table:
    compared = {each.name: results.rows[each.name] for each in ASSISTANTS}
    rows: list[tuple[Cell, ...]] = []
    for name, severity in product(compared, scores.SEVERITIES):
        own = [row for row in compared[name] if scores.pair_of(row) in baselines.nobody]
        total = sum(scores.SEVERITIES[severity](row) for row in own)
        if total == 0:
            continue
        followed = scores.followed_by_loss(own, severity, lambda row: bool(row["lost"]))
        without = scores.followed_by_loss(
            own, severity, lambda row: scores.pair_of(row) in baselines.lost
        )
        rows.append((name, severity, total, percent(followed), percent(without)))
    return Table(
        name="severities",
        title="Calibration of severity",
        columns=("assistant", "highest severity", "advisories", "loss", "loss without it"),
        rows=tuple(rows),
        notes=(
            "Loss: share of the advisories in runs that came to a loss all the same. Loss without "
            "it: share in runs that come to one without an assistant. Nominal runs count.",
        ),
    )


def _modalities(results: Results, baselines: Baselines) -> Table:
    rows = list(results.rows[MODALITIES]) + list(results.rows.get(VISION_ALONE, ()))
    groups = {"all": results.rows[REFERENCE.name]}
    for given, words in _given(results.choice).items():
        groups[words] = [row for row in rows if row["modalities"] == given]
    notes = [f"Assistant: `{REFERENCE.name}`."]
    if results.choice.has_cameras:
        notes.append("Vision alone: only scenarios with cameras.")
    return _compared(
        "modalities", "What each modality adds", "given", groups, results, baselines, notes
    )


def _topologies(results: Results, baselines: Baselines) -> Table:
    rows = results.rows[TOPOLOGIES]
    groups = {"parallel": results.rows[REFERENCE.name]}
    groups |= {name: [row for row in rows if row["topology"] == name] for name in FUSION}
    notes = [f"Assistant: `{REFERENCE.name}`."]
    return _compared("topologies", "Topologies", "topology", groups, results, baselines, notes)


def _crews(results: Results, baselines: Baselines) -> Table:
    rows = results.rows[CREWS]
    groups = {"icao": results.rows[REFERENCE.name]}
    groups |= {name: [row for row in rows if row[CREWS] == name] for name in BESIDE}
    notes = [
        f"Assistant: `{REFERENCE.name}`. Harm without an assistant is that of runs with `icao`: "
        "nobody then has anything to respond to but equipment."
    ]
    return _compared(CREWS, "How people respond", "crews", groups, results, baselines, notes)


def _compared(
    name: str,
    title: str,
    what: str,
    groups: Mapping[str, Sequence[Row]],
    results: Results,
    baselines: Baselines,
    notes: Iterable[str],
) -> Table:
    """Return a table of groups of runs within each family."""
    rows = [
        (family, group, *_scores(own, baselines))
        for family, group in product(_names(results), groups)
        if (own := _of_family(groups[group], family))
    ]
    columns = ("family", what, *SCORES)
    return Table(name=name, title=title, columns=columns, rows=tuple(rows), notes=tuple(notes))


def _names(results: Results) -> list[str]:
    return [*sorted({row["family"] for row in results.rows[NONE]}), EVERYTHING]


def _of_family(rows: Sequence[Row], family: str) -> list[Row]:
    return [row for row in rows if family in (row["family"], EVERYTHING)]


def _scores(rows: Sequence[Row], baselines: Baselines) -> tuple[Cell, ...]:
    """Return the cells of `SCORES`."""
    conflicts = scores.with_conflict(rows)
    return (
        share(scores.share(conflicts, "warned")),
        share(scores.share(conflicts, "warned_in_time")),
        share(scores.share(conflicts, "missed")),
        share(scores.avoided(conflicts, baselines)),
        number(scores.mean(conflicts, "lead_before_closest_approach_s"), 0),
        number(scores.nuisance_per_hour(rows)),
    )


def _margins(rows: Sequence[Row], baselines: Baselines) -> tuple[Cell, ...]:
    """Return the cells of `MARGINS`."""
    return (
        number(scores.mean(rows, "margin_over_tcas_ta_s"), 0),
        number(scores.mean(rows, "margin_over_tcas_ra_s"), 0),
        number(scores.margin_over_well_clear(rows, baselines), 0),
    )


PRESET = Preset(
    name="full",
    summary="all families and assistants, ablation of modalities, topologies and response models",
    seeds=3,
    specifications=specifications,
    tables=tables,
)
