"""The runs that a specification gives."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import airhilt
from airhilt.errors import AirhiltError
from airhilt.scenario import Scenario
from airhilt.scenario.perturbation import spreads
from airhilt.sweep.cases import Case, LoadedScenarios, cases
from airhilt.sweep.environment import PACKAGE_FILES, Environment, environment, require_same
from airhilt.sweep.files import NamedFiles
from airhilt.sweep.specification import Sample, Specification, specification_of
from engine_package import installed
from shortened import shortened

HERE = Environment(versions={"airhilt": "1"}, code_sha256="0", renderer="embree")


def given_as(**fields: Any) -> Specification:
    return specification_of({"scenarios": ["s02a_headon"], **fields}, "test")


def grid(**fields: Any) -> list[Case]:
    return cases(given_as(**fields))


def keys(found: list[Case]) -> set[str]:
    return {case.key(HERE) for case in found}


def test_a_grid_has_every_combination_once() -> None:
    found = grid(
        scenarios=["s02a_*"],
        seeds={"from": 0, "to": 2, "step": 1},
        axes={"snr_db": [0, 10, 10, 10.0], "assistant": ["reference", "none"]},
    )
    names = {case.scenario for case in found}
    assert all(name.startswith("s02a_") for name in names)
    assert len(names) > 1
    assert len(found) == len(names) * 3 * 2 * 2 == len(keys(found))


def test_sweeps_that_share_scenarios_have_the_runs_that_each_has_alone() -> None:
    shared = LoadedScenarios()
    path = "actors.AAL123.initial.cas_kt"
    for fields in ({}, {"axes": {path: [250, 270]}}, {"options": {"assistant": "none"}}):
        wanted = given_as(seeds=[0, 1], **fields)
        assert cases(wanted, scenarios=shared) == cases(wanted)


def test_a_parameter_of_the_scenario_is_set_in_its_place_alone() -> None:
    path = "actors.AAL123.initial.cas_kt"
    slow, fast = grid(axes={path: [250, 270]})
    speeds = [
        {actor["callsign"]: actor["initial"]["cas_kt"] for actor in case.document["actors"]}
        for case in (slow, fast)
    ]
    assert (speeds[0].pop("AAL123"), speeds[1].pop("AAL123")) == (250.0, 270.0)
    assert speeds[0] == speeds[1]
    assert [case.parameters for case in (slow, fast)] == [{path: 250.0}, {path: 270.0}]


def test_a_parameter_that_is_swept_is_not_drawn_any_more() -> None:
    (plain,) = grid()
    drawn = list(spreads(plain.document))
    path = drawn[0].replace("/", ".")
    (swept,) = grid(axes={path: [240]})
    assert list(spreads(swept.document)) == drawn[1:]


def test_settings_of_the_assistant_are_parameters() -> None:
    (case,) = grid(axes={"assistant.tau_asr": [0.5]})
    assert case.options["assistant_config"] == {"tau_asr": 0.5}
    assert case.parameters == {"assistant.tau_asr": 0.5}


def test_two_spellings_of_one_parameter_are_one() -> None:
    assert keys(grid(axes={"radio.snr_db": [5]})) == keys(grid(axes={"snr_db": [5]}))
    with pytest.raises(AirhiltError, match="snr_db: given twice"):
        grid(axes={"radio.snr_db": [5], "snr_db": [6]})
    with pytest.raises(AirhiltError, match="snr_db: given twice"):
        grid(axes={"radio.snr_db": [5]}, options={"snr_db": 6})
    with pytest.raises(AirhiltError, match="snr_db: given twice"):
        grid(axes={"/radio/snr_db": [5], "snr_db": [6]})


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({"scenarios": ["s09*"]}, "no scenario matches 's09"),
        ({"scenarios": ["s02a_hedon"]}, "did you mean 's02a_headon'"),
        ({"axes": {"weather.visibilty_m": [5]}}, "did you mean 'visibility_m'"),
        ({"axes": {"snr": [5]}}, "did you mean 'snr_db'"),
        ({"axes": {"actors.AAL12.initial.cas_kt": [5]}}, "did you mean 'AAL123'"),
        ({"axes": {"assistant.tau_as": [0.5]}}, "did you mean 'tau_asr'"),
        ({"axes": {"seed": [1]}}, "--seeds"),
        ({"axes": {"out": ["/tmp"]}}, "belongs to one run"),
        ({"seeds": [-1]}, "expected integers"),
        ({"axes": {"assistant": ["refrence"]}}, "did you mean 'reference'"),
        ({"axes": {"assistant.tau_asr": [0.5]}, "options": {"assistant": "none"}}, "do nothing"),
        ({"options": {"snr_dbb": 1}}, "unknown field; did you mean 'snr_db'"),
        ({"axes": {"name": ["other"]}}, "parameter name"),
    ],
)
def test_what_cannot_be_run_is_refused_by_name(fields: dict[str, Any], problem: str) -> None:
    with pytest.raises(AirhiltError, match=problem):
        grid(**fields)


def test_a_grid_without_end_is_refused_before_it_is_made() -> None:
    many = {"from": 1, "to": 10_000, "step": 1}
    with pytest.raises(AirhiltError, match="the grid has 100000000 runs"):
        grid(axes={"snr_db": many, "visibility_m": many})


def test_a_folder_that_an_option_names_is_part_of_the_key(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    model = tmp_path / "mine" / "model.bin"
    model.parent.mkdir()
    for options in (
        {"asr": "whisper:mine"},
        {"asr": "./mine"},
        {"assistant_config": {"a": "./mine"}},
    ):
        found = []
        for content in ("one", "another"):
            model.write_text(content)
            case = Case({"name": "x"}, options, 0, {}, NamedFiles().of({}, options))
            found.append(case.key(HERE))
        assert found[0] != found[1]


def test_every_kind_of_file_of_the_package_is_known_to_decide_results_or_not() -> None:
    package = Path(airhilt.__file__).parent
    of_none = {".html", ".svg", ".js", ".css", ".typed", ".pyc", ".md", ".LICENSE"}
    paths = (path for path in package.rglob("*") if path.is_file())
    endings = {path.suffix for path in paths if path.relative_to(package).parts[0] != "library"}
    assert endings <= {*PACKAGE_FILES, *of_none}


def test_all_values_that_a_scenario_refuses_are_told_at_once() -> None:
    with pytest.raises(AirhiltError) as refused:
        grid(axes={"actors.AAL123.initial.cas_kt": [250, 9000, -3], "snr_db": [0, 99]})
    told = str(refused.value)
    assert all(value in told for value in ("9000", "-3", "99"))
    assert "cas_kt=250, snr_db=0" not in told
    assert all(line.count("s02a_headon") == 1 for line in told.splitlines())


def test_all_values_that_a_run_would_refuse_are_told_at_once(tmp_path: Path) -> None:
    latencies = ["fixed,foo=fixed:1", "bad:3", f"replay:{tmp_path}/none", "fixed"]
    with pytest.raises(AirhiltError) as refused:
        grid(
            axes={"latency": latencies, "snr_db": {"from": 0, "to": 19, "step": 1}},
            options={"assistant": "external", "radio_profile": "missing.onnx"},
        )
    told = str(refused.value)
    assert "there is no stage 'foo'" in told
    assert "latency 'bad:3': expected" in told
    assert f"{tmp_path}/none" in told
    assert "learned channel missing.onnx: no such file" in told
    assert "--assistant external: no worker or program of yours attaches" in told
    assert len(told.splitlines()) == 5
    assert "(79 more)" in told


def test_a_recorded_latency_is_of_one_seed(encounter: Scenario, tmp_path: Path) -> None:
    out = tmp_path / "run"
    airhilt.run(encounter_of_a_second(encounter), out=out, latency="fixed", speech=False)
    path = tmp_path / "short.json"
    path.write_text(encounter_of_a_second(encounter).model_dump_json())
    asked = {"scenarios": [str(path)], "options": {"latency": f"replay:{out}", "speech": False}}
    assert len(grid(**asked, seeds=[0])) == 1
    with pytest.raises(AirhiltError, match="with seed 0; expected the same scenario and seed"):
        grid(**asked, seeds=[0, 1])


def encounter_of_a_second(encounter: Scenario) -> Scenario:
    return Scenario.model_validate(shortened(encounter.model_dump(mode="json"), 1.0))


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("actors.0.initial.cas_kt", "actors.AAL123.initial.cas_kt"),
        ("radio", "snr_db"),
        ("assistant.tau_asr", "assistant_config"),
    ],
)
def test_two_parameters_of_one_place_are_refused_by_name(one: str, other: str) -> None:
    with pytest.raises(AirhiltError, match=f"parameters {one} and {other}: one would replace"):
        grid(axes={one: [250], other: [260]})


# --- keys -----------------------------------------------------------------------------------


def test_whatever_changes_a_run_changes_its_key() -> None:
    variants = [
        grid(),
        grid(seeds=[1]),
        grid(axes={"assistant": ["paper"]}),
        grid(options={"speech": False}),
        grid(axes={"latency": ["fixed"]}),
        grid(axes={"actors.AAL123.initial.cas_kt": [251]}),
        grid(axes={"assistant.tau_asr": [0.7]}),
    ]
    found = [case.key(HERE) for (case,) in variants]
    others = [
        HERE.model_copy(update={"versions": {"airhilt": "2"}}),
        HERE.model_copy(update={"code_sha256": "1"}),
        HERE.model_copy(update={"renderer": "open3d"}),
    ]
    found += [variants[0][0].key(other) for other in others]
    assert len(set(found)) == len(found)


def test_an_option_that_is_written_out_is_the_same_run() -> None:
    assert keys(grid()) == keys(grid(options={"assistant": None}))
    assert keys(grid()) == keys(grid(axes={"assistant": ["reference"]}, options={"speech": True}))


def test_another_package_that_has_changed_makes_other_keys(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (case,) = grid()
    here = [environment("")]
    for code in ("ENGINE = 1", "ENGINE = 2", "ENGINE = 1"):
        with installed(tmp_path, monkeypatch, "airhilt.asr", "keyed", code):
            here.append(environment(""))
    assert here[1].packages == here[0].packages | {"outside_keyed": "1.0"}
    found = [case.key(each) for each in here]
    assert found[1] == found[3]
    assert len(set(found)) == 3
    with pytest.raises(AirhiltError, match=r"outside_keyed missing instead of 1\.0"):
        require_same(here[1], here[0], "tcp://a")
    with pytest.raises(AirhiltError, match="tcp://a: other code of outside_keyed; expected"):
        require_same(here[1], here[2], "tcp://a")


# --- samples --------------------------------------------------------------------------------


@settings(deadline=None)
@given(
    method=st.sampled_from(["sobol", "latin_hypercube"]),
    count=st.integers(1, 40),
    seed=st.integers(0, 99),
)
def test_samples_lie_in_their_intervals_and_are_the_same_again(
    method: str, count: int, seed: int
) -> None:
    sample = Sample.model_validate(
        {
            "method": method,
            "count": count,
            "seed": seed,
            "intervals": {
                "snr_db": {"from": -5, "to": 20},
                "visibility_m": {"from": 400, "to": 10000, "scale": "log"},
            },
        }
    )
    found = sample.points()
    assert found == sample.points()
    assert len(found) == count
    assert all(
        -5 <= point["snr_db"] <= 20 and 400 <= point["visibility_m"] <= 10_000 for point in found
    )


def test_each_point_of_a_sample_meets_the_whole_grid() -> None:
    sample = {
        "method": "sobol",
        "count": 4,
        "intervals": {"snr_db": {"from": 0, "to": 20}},
    }
    found = grid(sample=sample, axes={"assistant": ["reference", "none"]}, seeds=[0, 1, 2])
    assert len(keys(found)) == 4 * 2 * 3
    assert len({case.parameters["snr_db"] for case in found}) == 4
