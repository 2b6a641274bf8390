"""Evaluations: what their presets run, and the tables that come of it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from click.testing import CliRunner

from airhilt.cli.commands.evaluate import COMMAND
from airhilt.errors import AirhiltError
from airhilt.host import library
from airhilt.record.sweep_folder import SweepFolder
from airhilt.report.evaluation.tables import render
from airhilt.report.figures import Figures
from airhilt.scenario import Scenario
from airhilt.sweep.axes import listed
from airhilt.sweep.engine import SweepObserver, SweepResult
from airhilt.sweep.evaluation import ranking
from airhilt.sweep.evaluation.assistants import ASSISTANTS, shipped_scenarios
from airhilt.sweep.evaluation.costs import costs
from airhilt.sweep.evaluation.engine import Evaluation, estimates, evaluate
from airhilt.sweep.evaluation.preset import Choice, Preset, Results, Row
from airhilt.sweep.evaluation.presets import full, paper, recipients, roc
from airhilt.sweep.evaluation.presets import ranking as yours
from airhilt.sweep.evaluation.ranking import Tried, youden_index
from airhilt.sweep.evaluation.scores import (
    Baselines,
    avoided,
    followed_by_loss,
    margin_over_well_clear,
    nuisance_per_hour,
)
from airhilt.sweep.evaluation.tables import Quantity, Table, number, share
from airhilt.sweep.outcome import Machine, Outcome, Request
from airhilt.sweep.specification import Specification
from airhilt.sweep.work import Work
from shortened import shortened
from sweep_tables import sweep_row, write_sweep

NO_CAMERAS = Choice(1, {"cameras": False})
EVERYTHING = Choice(1, {})
PARTS = ("speech", "recognition", "evidence", "decision", "voice")


def row(scenario: str = "s01a_one", seed: int = 0, **fields: Any) -> dict[str, Any]:
    """Return a row of a run in which somebody was warned 8 s after the begin, and all went well."""
    return {
        "scenario": scenario, "seed": seed, "family": scenario[:4].upper(), "status": "finished",
        "nominal": False, "warned": True, "warned_in_time": True, "missed": False, "lost": False,
        "avoided": True, "t_first_warning_s": 28.0, "time_to_first_warning_s": 8.0,
        "lead_before_closest_approach_s": 30.0, "margin_over_tcas_ta_s": 5.0,
        "margin_over_tcas_ra_s": 15.0, "nuisance_alerts": 0, "clarifications": 0,
        "duration_s": 1800.0,
        "advisories": 2, "cautions": 1, "warnings": 1, "latencies_asr_p50_s": 5.9,
        "latencies_vision_p50_s": None, "collision": False, "nmac": False,
        "loss_of_separation": False, "runway_incursion_category": None,
        "first_detection_range_m": None, "costs_go_arounds": 0, "costs_rejected_takeoffs": 0,
        "radio_occupied_s": 20.0, "costs_level_deviation_ft_s": 0.0,
        "costs_path_deviation_nm_s": 0.0, "costs_advice_spoken_s": 4.0,
        "time_to_first_warning_after_window_s": 6.0,
        **{f"first_warning_parts_{part}_s": 1.0 for part in PARTS}, **fields,
    }  # fmt: skip


def cells(table: Table, *key: str) -> dict[str, Any]:
    """Return the cells of the row that begins with a key, by their columns."""
    (found,) = [row for row in table.rows if row[: len(key)] == key]
    return dict(zip(table.columns, found, strict=True))


def text(cell: Any) -> str:
    return cell.text if isinstance(cell, Quantity) else str(cell)


# --- scores ---------------------------------------------------------------------------------


def test_only_what_is_lost_without_an_assistant_can_be_avoided() -> None:
    nobody = [row(seed=0, avoided=False), row(seed=1, avoided=False), row(seed=2, avoided=None)]
    baselines = Baselines.of(nobody, [])
    rows = [row(seed=0), row(seed=1, avoided=False), row(seed=2)]
    assert (avoided(rows, baselines).value, avoided(rows, baselines).n) == (0.5, 2)


def test_a_conflict_that_did_not_come_about_with_an_assistant_was_avoided() -> None:
    baselines = Baselines.of([row(avoided=False)], [])
    assert avoided([row(avoided=None, warned=False)], baselines).value == 1.0


def test_a_margin_over_well_clear_is_that_of_the_same_run() -> None:
    other = [row(seed=0, t_first_warning_s=48.0), row(seed=1, t_first_warning_s=None)]
    baselines = Baselines.of([], other)
    found = margin_over_well_clear([row(seed=0), row(seed=1), row(seed=2)], baselines)
    assert (found.value, found.n) == (20.0, 1)


def test_nuisance_is_counted_in_hours_of_nominal_traffic() -> None:
    rows = [
        row(nuisance_alerts=9),
        row(nominal=True),
        row(nominal=True, nuisance_alerts=3),
        row(nominal=True, nuisance_alerts=None),
    ]
    assert nuisance_per_hour(rows).value == 3.0


def test_severity_is_judged_by_the_advisories_that_a_loss_followed() -> None:
    rows = [row(cautions=3, lost=True), row(cautions=1), row(cautions=0, lost=True)]
    assert followed_by_loss(rows, "CAUTION", lambda one: one["lost"]).value == 0.75
    found = followed_by_loss(rows, "WARNING", lambda one: one["lost"])
    assert (found.value, found.n) == (pytest.approx(2 / 3), 3)


# --- the ranking ----------------------------------------------------------------------------

MANY = [f"s01a_{number}" for number in range(8)]


def tried(*, lost: int = 0, disturbed: int = 0, brought_about: int = 0) -> Tried:
    """Return runs with 6 conflicts that are lost without an assistant, 2 others, and 8 twins."""
    harmed = {*MANY[:lost], *MANY[6 : 6 + brought_about]}
    twins = {*MANY[:disturbed]}
    return Tried(
        [row(name, lost=name in harmed) for name in MANY],
        [row(name, nominal=True, nuisance_alerts=2 * (name in twins)) for name in MANY],
    )


NOBODY = [row(name, lost=name in MANY[:6]) for name in MANY]


def test_the_index_is_one_for_all_averted_and_nobody_disturbed() -> None:
    assert youden_index(tried(), NOBODY).value == 1.0


def test_who_says_nothing_has_an_index_of_0_and_who_warns_of_everything_at_most_that() -> None:
    assert youden_index(tried(lost=6), NOBODY).value == 0.0
    assert youden_index(tried(disturbed=8), NOBODY).value == 0.0
    assert youden_index(tried(lost=2, disturbed=8), NOBODY).value == pytest.approx(-1 / 3)


def test_what_an_assistant_brings_about_is_taken_from_what_it_averts() -> None:
    found = youden_index(tried(lost=1, brought_about=2), NOBODY)
    assert found.value == pytest.approx((5 - 2) / 6)
    assert found.low is not None
    assert found.low < found.value < found.high


def test_harm_in_a_twin_disturbs_it_though_nobody_was_alerted() -> None:
    harmed = Tried(tried().conflicts, [row(name, nominal=True, lost=True) for name in MANY])
    assert youden_index(harmed, NOBODY).value == 0.0


def test_who_asks_about_everything_disturbs_every_twin() -> None:
    asked = [row(name, nominal=True, clarifications=7) for name in MANY]
    assert youden_index(Tried(tried().conflicts, asked), NOBODY).value == 0.0


def test_the_highest_index_stands_first_in_the_ranking() -> None:
    table = ranking.table({"silent": tried(lost=6), "good": tried(disturbed=1)}, NOBODY)
    assert [line[0] for line in table.rows] == ["good", "silent"]
    found = cells(table, "good")
    assert text(found["averted"]).startswith("6 of 6")
    assert text(found["brought about"]).startswith("0 of 2")
    assert text(found["twins undisturbed"]).startswith("7 of 8")


def test_the_controls_are_in_every_preset() -> None:
    for preset in (paper, full, recipients, roc, yours):
        names = preset.specifications(NO_CAMERAS).keys()
        assert {"silent", "cry_wolf", "twins_silent", "twins_cry_wolf"} <= names


def test_an_assistant_at_an_address_is_ranked_beside_the_reference() -> None:
    url = "http://127.0.0.1:9000/decide"
    every = yours.specifications(Choice(1, {"cameras": False}, (url, "paper")))
    assert every["http_127.0.0.1_9000_decide"].options["assistant"] == url
    assert every["twins_http_127.0.0.1_9000_decide"].options["twin"]
    assert {"none", "paper", "reference", "silent", "cry_wolf"} <= every.keys()
    (ranked,) = yours.tables(Results(NO_CAMERAS, dict.fromkeys(every, NOBODY)))
    assert "http_127.0.0.1_9000_decide" in {line[0] for line in ranked.rows}


def test_thresholds_are_multiplied_wherever_an_assistant_has_them() -> None:
    every = roc.specifications(NO_CAMERAS)
    assert every["surf_a_x2"].options["assistant_config"] == {"caution_s": 60.0, "warning_s": 30.0}
    assert every["paper_x0.5"].options["assistant_config"] == {"time_to_go_s": 4.0}
    nested = every["twins_reference_x4"].options["assistant_config"]
    assert nested["separation"]["warning_s"] == 240.0  # type: ignore[index, call-overload]
    assert "assistant_config" not in every["reference"].options
    assert "tcas_x2" not in every


def test_what_is_missed_stands_against_what_disturbs_in_a_figure() -> None:
    rows: dict[str, list[Row]] = {name: [] for name in roc.specifications(NO_CAMERAS)}
    rows["none"] = list(NOBODY)
    for factor, missed in ("_x0.5", 6), ("", 3), ("_x2", 0):
        rows[f"surf_a{factor}"] = [
            row(name, warned=place >= missed) for place, name in enumerate(MANY)
        ]
        rows[f"twins_surf_a{factor}"] = [
            row(name, nominal=True, nuisance_alerts=6 - missed) for name in MANY
        ]
    characteristic, ranked = roc.tables(Results(NO_CAMERAS, rows))
    assert text(cells(characteristic, "surf_a", "1")["missed"]).startswith("3 of 6"), (
        "of the runs with harm"
    )
    points = [
        (cells(characteristic, "surf_a", factor)["nuisance, 1/h"].value,
         cells(characteristic, "surf_a", factor)["missed"].value)
        for factor in ("0.5", "1", "2")
    ]  # fmt: skip
    assert points == [(0.0, 1.0), (6.0, 0.5), (12.0, 0.0)]
    assert cells(ranked, "surf_a")["twins undisturbed"].value == 0.0
    document = {
        "preset": "roc", "seeds": 1, "options": {}, "sweeps": {},
        "tables": [characteristic.model_dump(mode="json")],
    }  # fmt: skip
    assert "<svg" in render(document, Figures())


# --- the paper ------------------------------------------------------------------------------


def paper_tables(rows: Sequence[Row], choice: Choice = NO_CAMERAS) -> dict[str, Table]:
    results = Results(choice, {"none": [], "paper": rows})
    return {table.name: table for table in paper.tables(results)}


def test_the_paper_has_its_numbers_beside_ours() -> None:
    late = row(seed=1, time_to_first_warning_s=10.0, first_warning_parts_evidence_s=0.0)
    table = paper_tables([row(), late])["comparison"]
    warning = cells(table, "time to first warning, s")
    assert (warning["the paper"], warning["mean"].value, warning["runs"]) == ("7.66", 9.0, 2)
    by_call = cells(table, str(table.rows[1][0]))
    assert (by_call["mean"].value, by_call["runs"]) == (10.0, 1)
    assert cells(table, "ASR latency, s")["origin"] == "given by --latency"
    assert cells(table, "vision latency, s")["origin"] == "not measured"
    assert any("Without cameras" in note for note in table.notes)


def test_warnings_before_the_begin_count_as_such() -> None:
    never_began = row(seed=1, time_to_first_warning_s=None)
    nobody: dict[str, Any] = {"t_first_warning_s": None, "time_to_first_warning_s": None}
    rows = [row(time_to_first_warning_s=-3.0), never_began, row(seed=2), row(seed=3, **nobody)]
    found = cells(paper_tables(rows)["variants"], "all")
    assert (found["warned"], found["before"]) == ("3 of 4", "67 %")
    assert found["mean"].value == 2.5


# --- all families ---------------------------------------------------------------------------


def test_an_assistant_runs_where_it_has_something_to_read() -> None:
    scenarios = shipped_scenarios()
    own = {
        each.name: {name for name, one in scenarios.items() if each.applies_to(one)}
        for each in ASSISTANTS
    }
    assert own["reference"] == set(scenarios)
    assert "s01c_deer_undetected" in own["paper"]
    assert "s02a_headon" not in own["paper"] | own["surf_a"]
    assert "s01c_deer_undetected" not in own["adsb_only"] | own["surf_a"]
    assert {"s01b_noncompliance", "s02a_headon", "s01c_nominal"} <= own["adsb_only"]
    assert "s01b_dropped_hold" not in own["surf_a"]
    assert own["tcas"] == own["well_clear"]
    assert "s02c_intruder_headon" not in own["tcas"]
    assert "s01a_nominal" not in own["tcas"]


def test_without_cameras_and_sound_the_sweeps_that_need_them_are_left_out() -> None:
    every = full.specifications(EVERYTHING)
    assert {
        "none",
        "reference",
        "modalities",
        "vision_alone",
        "topologies",
        "crews",
    } <= every.keys()
    assert len(listed(every["modalities"].axes["modalities"])) == 5
    fewer = full.specifications(Choice(1, {"cameras": False, "speech": False}))
    assert every.keys() - fewer.keys() == {"vision_alone", "topologies"}
    assert listed(fewer["modalities"].axes["modalities"]) == ("asr", "adsb")


def test_other_response_models_stand_beside_unless_the_user_chooses_one() -> None:
    assert listed(full.specifications(EVERYTHING)["crews"].axes["crews"]) == ("ideal", "observed")
    chosen = full.specifications(Choice(1, {"crews": "observed"}))
    assert "crews" not in chosen
    assert chosen["reference"].options["crews"] == "observed"


def test_engines_that_nobody_would_ask_are_left_out_without_an_assistant() -> None:
    given = {"asr": "whisper:model", "tts": "flite"}
    found = full.specifications(Choice(1, given))
    assert found["none"].options == {"latency": "fixed", "assistant": "none", "tts": "flite"}
    assert found["reference"].options["asr"] == "whisper:model"


def full_tables(choice: Choice = NO_CAMERAS) -> dict[str, Table]:
    """Return the tables of made-up runs: without an assistant everything is lost."""
    scenarios = shipped_scenarios()

    def rows(own: Sequence[str], **fields: Any) -> list[dict[str, Any]]:
        return [row(name, nominal=scenarios[name].conflict is None, **fields) for name in own]

    found: dict[str, list[Row]] = {}
    for name, one in full.specifications(choice).items():
        lost = {"avoided": False, "lost": True} if name == "none" else {}
        found[name] = []
        for path, values in one.axes.items() or {"scenario": ("",)}.items():
            for value in listed(values):
                extra = {} if path == "scenario" else {path: value}
                found[name] += rows(one.scenarios, **lost, **extra)
    return {table.name: table for table in full.tables(Results(choice, found))}


def test_a_family_in_which_an_assistant_has_nothing_to_read_is_not_held_against_it() -> None:
    table = full_tables()["families"]
    listed_pairs = {(line[0], line[1]) for line in table.rows}
    assert ("S01A", "surf_a") in listed_pairs
    assert ("S02A", "surf_a") not in listed_pairs
    assert text(cells(table, "S01B", "adsb_only")["warned"]).startswith("3 of 3")
    assert any("`adsb_only` does not apply to" in note for note in table.notes)
    assert text(cells(table, "all", "reference")["avoided"]).startswith("24 of 24")


def test_what_is_not_avoided_is_told_by_the_worst_that_came_of_it() -> None:
    name = "s01a_bad_readback"
    bad = [row(name, seed, avoided=False, collision=True) for seed in range(4)]
    ends: list[dict[str, Any]] = [
        {"avoided": None, "warned": False},
        {"avoided": False, "collision": True, "runway_incursion_category": "accident"},
        {"avoided": False, "runway_incursion_category": "B"},
        {"avoided": False, "loss_of_separation": True, "runway_incursion_category": "C"},
    ]
    rows: dict[str, list[Row]] = {sweep: [] for sweep in full.specifications(NO_CAMERAS)}
    rows |= {"none": [*bad, row(name, 4)], "reference": [row(name, 4)]}
    rows["reference"] += [row(name, seed, **end) for seed, end in enumerate(ends)]
    (table,) = [one for one in full.tables(Results(NO_CAMERAS, rows)) if one.name == "harms"]
    found = cells(table, name)
    assert found["none"] == "collision 4"
    assert found["reference"] == "avoided 1, collision 1, incursion B 1, loss of separation 1"
    assert found["paper"] == "-"


def test_who_is_told_is_compared_over_the_same_runs_with_each_response_model() -> None:
    every = recipients.specifications(Choice(20, {}))
    told = {
        name: listed(one.axes["recipients"])
        for name, one in every.items()
        if "recipients" in one.axes
    }
    with_twins = ("without_cameras", "with_cameras", "twins_reference")
    assert told == dict.fromkeys(with_twins, recipients.TOLD)
    assert {listed(one.axes["crews"]) for one in every.values() if "crews" in one.axes} == {
        ("ideal", "icao", "observed")
    }
    assert len(listed(every["without_cameras"].seeds)) == 20
    assert len(listed(every["with_cameras"].seeds)) == 3
    assert every["without_cameras"].options["cameras"] is False
    assert not any(name.startswith("with_") for name in recipients.specifications(NO_CAMERAS))

    lost: dict[str, Any] = {"avoided": False, "lost": True, "collision": True}
    nobody = [row(crews="ideal", **lost), row(crews="observed"), row(crews="icao", **lost)]
    rows = [
        row(recipients="both", crews="ideal"),
        row(recipients="crew", crews="ideal", **lost),
        row(recipients="crew", crews="observed"),
        row(recipients="crew", crews="icao"),
    ]
    twins = [row(recipients=told, nominal=True) for told in recipients.TOLD]
    sweeps = {
        "without_cameras": rows, "without_cameras_nobody": nobody, "twins_reference": twins,
    }  # fmt: skip
    results = Results(NO_CAMERAS, sweeps)
    tables = {table.name: table for table in recipients.tables(results)}
    families = tables["recipients"]
    assert text(cells(families, "all", "both", "ideal")["avoided"]).startswith("1 of 1")
    assert text(cells(families, "all", "crew", "ideal")["avoided"]).startswith("0 of 1")
    assert text(cells(families, "all", "crew", "observed")["avoided"]) == "-"
    found = cells(tables["harms_ideal"], "s01a_one")
    assert (found["nobody"], found["crew"], found["both"]) == (
        "collision 1",
        "collision 1",
        "avoided 1",
    )
    assert tables["harms_observed"].rows == ()
    assert cells(tables["ranking"], "reference, crew told")["index"].value == 1.0


def test_what_an_assistant_costs_is_counted_against_the_same_run_without_one() -> None:
    broken: dict[str, Any] = {"costs_go_arounds": 1, "costs_rejected_takeoffs": 1}
    nobody = [row(seed=seed, costs_go_arounds=1) for seed in range(2)]
    baselines = Baselines.of(nobody, [])
    rows = [row(seed=0, radio_occupied_s=32.0, **broken), row(seed=1), row(seed=9, **broken)]
    assert [cell.value for cell in costs(rows, baselines)] == [0.0, 6.0, 4.0]


def test_one_response_model_alone_is_compared_if_it_is_chosen() -> None:
    every = recipients.specifications(Choice(1, {"crews": "observed"}))
    swept = {listed(one.axes["crews"]) for one in every.values() if "crews" in one.axes}
    assert swept == {("observed",)}
    assert every["cry_wolf"].options["crews"] == "observed"
    results = Results(Choice(1, {"crews": "observed"}), {name: [] for name in every})
    tables = {table.name for table in recipients.tables(results)}
    assert tables == {"recipients", "ranking", "harms_observed"}


def test_severity_modalities_topologies_and_crews_have_tables() -> None:
    found = full_tables(EVERYTHING)
    severe = cells(found["severities"], "reference", "WARNING")
    assert (text(severe["loss"]), severe["advisories"]) == (
        "0 % (0 to 11 %)",
        len(library.names("scenarios")),
    )
    assert severe["loss without it"].value == 1.0
    given = {line[1] for line in found["modalities"].rows}
    assert given == {"all", *full.WITH_VISION.values()}
    assert {line[1] for line in found["topologies"].rows} == {"parallel", *full.FUSION}
    assert {line[1] for line in found["crews"].rows} == {"icao", "ideal", "observed"}


# --- tables ---------------------------------------------------------------------------------


def test_cells_have_their_numbers_and_a_text() -> None:
    from airhilt.metrics.estimates import UNKNOWN, Estimate

    assert share(Estimate(0.75, 0.3, 0.95, 4)).text == "3 of 4 (30 to 95 %)"
    assert share(Estimate(0.0, 0.0, 0.0042, 908)).text == "0 of 908 (0 to 0.4 %)"
    assert number(Estimate(7.66, 7.0, 8.0, 5), 2).text == "7.66 (7.00 to 8.00)"
    assert number(Estimate(7.66, None, None, 1), 0).text == "8"
    assert number(Estimate(-0.2, -1.3, 0.1, 3), 0).text == "0 (-1 to 0)"
    assert share(UNKNOWN).text == number(UNKNOWN).text == "-"


# --- with real runs -------------------------------------------------------------------------


class Stopping(SweepObserver):
    """Wants to stop at once."""

    stops = True


@contextmanager
def unwatched(_name: str) -> Iterator[SweepObserver]:
    yield SweepObserver()


@contextmanager
def stopping(_name: str) -> Iterator[SweepObserver]:
    yield Stopping()


@pytest.fixture
def small(encounter: Scenario, tmp_path: Path) -> Preset:
    """A preset of two short runs."""
    path = tmp_path / "short.json"
    short = shortened(encounter.model_dump(mode="json"), 4.0) | {"name": "short"}
    path.write_text(json.dumps(short))

    def tables(results: Results) -> Sequence[Table]:
        rows: Sequence[Mapping[str, Any]] = results.rows["only"]
        lines = tuple((one["assistant"], one["seed"]) for one in rows)
        return (Table(name="runs", title="Runs", columns=("assistant", "seed"), rows=lines),)

    return Preset(
        name="small",
        summary="two short runs",
        seeds=2,
        specifications=lambda choice: {
            "only": choice.specification([str(path)], {"assistant": "none", "latency": "fixed"})
        },
        tables=tables,
    )


def test_the_help_names_every_preset(small: Preset, monkeypatch: pytest.MonkeyPatch) -> None:
    shown = SimpleNamespace(names=lambda: [small.name], load=lambda _: small)
    monkeypatch.setattr("airhilt.sweep.evaluation.presets.FAMILY", shown)
    assert "small: two short runs." in CliRunner().invoke(COMMAND, ["--help"]).output


def test_an_evaluation_leaves_sweeps_and_tables_and_goes_on_where_it_was(
    small: Preset, tmp_path: Path
) -> None:
    choice, work = Choice(2, {"speech": False}), Work(tmp_path / "out", workers=1)
    assert evaluate(small, choice, work, stopping) is None
    assert not (tmp_path / "out" / "evaluation.json").exists()
    found = evaluate(small, choice, work, unwatched)
    assert isinstance(found, Evaluation)
    assert (found.runs, found.rows) == (2, 2)
    written = json.loads((tmp_path / "out" / "evaluation.json").read_text())
    assert sorted(written["tables"][0]["rows"]) == [["none", 0], ["none", 1]]
    assert len(written["sweeps"]["only"]["table_sha256"]) == 64
    assert (tmp_path / "out" / "evaluation.md").read_text() == found.markdown()
    page = (tmp_path / "out" / "evaluation.html").read_text()
    assert written["sweeps"]["only"]["table_sha256"] in page
    assert "<td>none</td><td>1</td>" in page
    before = (tmp_path / "out" / "evaluation.json").read_bytes()
    evaluate(small, choice, work, unwatched)
    assert (tmp_path / "out" / "evaluation.json").read_bytes() == before


def test_a_dry_run_tries_one_run_of_each_kind(
    small: Preset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "short.json"
    document = json.loads(path.read_text())
    nose = {"type": "actor", "actor": document["actors"][0]["callsign"], "station": "nose"}
    path.write_text(json.dumps(document | {"cameras": [{"name": "nose", "mount": nose}]}))

    def specifications(choice: Choice) -> Mapping[str, Specification]:
        alone = small.specifications(choice)["only"]

        def with_options(**options: Any) -> Specification:
            return alone.model_copy(update={"options": {**alone.options, **options}})

        return {
            "alone": alone,
            "blind": with_options(assistant="paper", modalities="adsb"),
            "no detector": with_options(assistant="paper", detector="none"),
            "seeing": with_options(assistant="paper"),
            "silent": with_options(speech=False),
            "both": alone.model_copy(
                update={"axes": {"assistant": ["none", "paper"]}, "options": {"latency": "fixed"}}
            ),
        }

    tried: list[Request] = []

    def run(_: object, request: Request) -> Outcome:
        tried.append(request)
        machine = Machine(wall_s=len(tried), cpu_s=None, peak_memory_mb=0.0, host="here", process=1)
        return Outcome(key=request.key, status="finished", cause="", is_kept=False, machine=machine)

    monkeypatch.setattr("airhilt.sweep.runner_process.RunnerProcess.run", run)
    found = estimates(
        replace(small, specifications=specifications), Choice(2, {}), Work(tmp_path / "out")
    )
    assert {name: (each.runs, each.run_s) for name, each in found.items()} == {
        "alone": (2, 1.0),
        "blind": (2, 1.0),
        "no detector": (2, 1.0),
        "seeing": (2, 2.0),
        "silent": (2, 3.0),
        "both": (4, 1.5),
    }
    assert len(tried) == 3


@pytest.mark.slow
def test_what_one_sweep_refuses_is_told_before_the_first_one(tmp_path: Path) -> None:
    """Without an assistant, as in the first sweep, nobody asks for the recogniser."""
    chosen = Choice(1, {"cameras": False, "asr": "nonsense"})
    with pytest.raises(AirhiltError, match="nonsense"):
        evaluate(full.PRESET, chosen, Work(tmp_path / "out", workers=1), unwatched)
    assert not (tmp_path / "out").exists()


def test_runs_that_failed_are_named_under_each_table(
    small: Preset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = [sweep_row("short", "none", 0), sweep_row("short", "none", 1, status="failed")]
    folder = SweepFolder(write_sweep(tmp_path / "out" / "only", rows))
    result = SweepResult(folder, runs=5, rows=2, failed=1, missing=3)
    monkeypatch.setattr("airhilt.sweep.evaluation.engine.sweep", lambda *_: result)
    found = evaluate(small, Choice(2, {"speech": False}), Work(tmp_path / "out"), unwatched)
    assert found is not None
    assert not found.is_complete
    (table,) = found.tables
    assert table.rows == (("none", 0),)
    assert table.notes == (
        "1 run failed and is left out of the tables (1 of `only`): the causes are in "
        "machine.parquet there.",
        "3 runs did not begin and are left out of the tables (3 of `only`).",
    )


def test_tables_of_others_are_not_replaced(small: Preset, tmp_path: Path) -> None:
    (tmp_path / "evaluation.md").write_text("mine")
    with pytest.raises(AirhiltError, match=r"evaluation\.md of no evaluation"):
        evaluate(small, Choice(1, {}), Work(tmp_path), unwatched)
    assert (tmp_path / "evaluation.md").read_text() == "mine"
