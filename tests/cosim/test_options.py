"""Options are written once: Python, the command line and run.json take them from one model."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt.cli.run_flags import run_flags
from airhilt.cosim.recorded import Recorded
from airhilt.cosim.replay import replay
from airhilt.cosim.setup import Setup, check_given
from airhilt.errors import AirhiltError
from airhilt.options import Options, flag_of, options_of
from airhilt.record import RunFolder
from airhilt.report import write_report
from airhilt.scenario import Scenario
from decisions import reference


def test_a_wrong_name_is_answered_with_the_nearest_right_one() -> None:
    with pytest.raises(TypeError, match="no option named 'latenzy'; did you mean 'latency'"):
        airhilt.run("s02a_headon", latenzy="fixed")


def test_a_wrong_value_is_named_with_its_option() -> None:
    with pytest.raises(AirhiltError, match="option snr_db"):
        airhilt.run("s02a_headon", snr_db=1000.0)


@pytest.mark.parametrize("name", ["a*", "#", "a/b", "../x", "", "$run", "a?", "a b", "x" * 81])
def test_a_run_is_not_named_by_what_is_no_part_of_a_key(name: str) -> None:
    with pytest.raises(AirhiltError, match=r"option run_name: found .*expected at most 80 letters"):
        airhilt.run("s02a_headon", run_name=name)


def test_every_option_that_the_command_line_spells_is_a_flag_of_a_run() -> None:
    spelled = {name for name, field in Options.model_fields.items() if flag_of(field)}
    assert {flag.name for flag in run_flags()} == spelled
    assert spelled >= {"seed", "latency", "endpoint", "snr_db"}


def test_a_given_visibility_replaces_the_drawn_one_and_no_other_draw() -> None:
    scenario = airhilt.load("s01a_bad_readback")
    drawn = Setup(scenario, Options(seed=3), Recorded())
    given = Setup(scenario, Options(seed=3, visibility_m=5000.0), Recorded())
    assert drawn.scenario.weather.visibility_m not in (1500.0, 5000.0)
    weather = drawn.scenario.weather.model_copy(update={"visibility_m": 5000.0})
    assert given.scenario == drawn.scenario.model_copy(update={"weather": weather})
    assert (given.given, given.draws) == (scenario, drawn.draws)


def test_a_run_without_a_report_can_have_one_later(encounter: Scenario, tmp_path: Path) -> None:
    short = encounter.model_copy(update={"duration_s": 1.0})
    folder = airhilt.run(short, out=tmp_path / "run", speech=False, report=False).folder
    assert (folder / "summary.json").is_file()
    assert not (folder / "report.html").exists()
    assert write_report(folder).is_file()


def test_run_json_holds_the_options_whole(encounter: Scenario, tmp_path: Path) -> None:
    given = Options(
        seed=3, out=tmp_path / "run", latency="fixed", snr_db=12.5, speech=False, cameras=False,
        assistant="none", step_timeout_s=7.0,
    )  # fmt: skip
    airhilt.run(encounter, **dict(given))
    assert RunFolder(tmp_path / "run").info().options == given


def test_run_json_holds_the_configuration_of_the_assistant_and_a_replay_has_it(
    encounter: Scenario, tmp_path: Path
) -> None:
    file = tmp_path / "mine.json"
    file.write_text('{"separation": {"caution_s": 90}}')
    airhilt.run(
        encounter, out=tmp_path / "run", assistant_config=file, latency="fixed", speech=False,
        cameras=False,
    )  # fmt: skip
    file.unlink()
    (decision,) = RunFolder(tmp_path / "run").info().workers
    separation = decision.description.configuration["separation"]
    assert (separation["caution_s"], separation["warning_s"]) == (90.0, 60.0)
    assert replay(tmp_path / "run").identical


def test_a_configuration_of_a_worker_of_the_user_is_refused(
    encounter: Scenario, tmp_path: Path
) -> None:
    for option, given in (("assistant-config", {}), ("recipients", "crew")):
        options: dict[str, Any] = {option.replace("-", "_"): given}
        with pytest.raises(AirhiltError, match=f"--{option} would do nothing: a worker"):
            airhilt.run(encounter, out=tmp_path / "run", workers=[reference()], **options)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"wording": "tmplate"}, "wording 'tmplate': there is none of that"),
        ({"wording": "tmplate", "assistant": "none"}, "'tmplate' would do nothing with --assist"),
        ({"asr": "typo", "assistant": "none"}, "'typo' would do nothing with --assistant none"),
        ({"detector": "typo", "cameras": False}, "'typo' would do nothing with --no-cameras"),
        ({"detector": "typo"}, "detector 'typo': there is none of that name"),
        ({"detector_classes": "aircraft"}, "found 'aircraft'; expected pairs such as"),
        ({"detector_classes": "jet=airplane"}, "with --detector 'embedded', which has its own"),
        ({"tts": "typo"}, "voice 'typo': there is none of that name"),
        ({"asr": "folder/none.onnx"}, "there is none of that name"),
        ({"assistant": "typo"}, "'typo': there is none of that name; expected .*, or external"),
    ],
)
def test_a_run_begins_with_no_engine_that_is_not_there(
    given: dict[str, Any], told: str, encounter: Scenario, tmp_path: Path
) -> None:
    with pytest.raises(AirhiltError, match=told):
        airhilt.run(encounter, out=tmp_path / "run", **given)
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"detector": "yolo:FILE", "cameras": False}, "--detector 'yolo:FILE' .* --no-cameras"),
        ({"detector": "yolo:FILE", "assistant": "none"}, "would do nothing with --assistant none"),
        ({"asr": "embedded:.", "speech": False}, "would do nothing with --no-speech"),
        ({"asr": "embedded:.", "assistant": "none"}, "would do nothing with --assistant none"),
        ({"assistant_config": {}, "assistant": "none"}, "^--assistant-config {} would do nothing"),
        ({"video": True, "cameras": False}, "^--video would do nothing with --no-cameras"),
        (
            {"visibility_m": 800.0, "cameras": False},
            "^--visibility 800.0 would do nothing with --n",
        ),
    ],
)
def test_an_option_that_does_nothing_is_refused_from_python_too(
    given: dict[str, Any], told: str, encounter: Scenario
) -> None:
    with pytest.raises(AirhiltError, match=told):
        Setup(encounter, options_of(given), Recorded())


@pytest.mark.parametrize(
    "given",
    [
        {"asr": "embedded:.", "assistant": "none", "topology": "asr_first"},
        {"detector": "embedded", "cameras": False},
        {"asr": "http://127.0.0.1:1/asr"},
        {"detector": "none"},
        {"assistant": "external", "asr": "embedded:."},
    ],
)
def test_an_option_that_does_something_or_nothing_new_is_taken(
    given: dict[str, Any], encounter: Scenario
) -> None:
    assert Setup(encounter, options_of(given), Recorded()).options.model_fields_set == set(given)


@pytest.mark.parametrize("name", ["", "  "])
def test_a_language_model_has_a_name(name: str) -> None:
    with pytest.raises(ValueError, match="llm_model"):
        Options(assistant="llm", llm="http://127.0.0.1:1/v1", llm_model=name)


def test_an_engine_that_is_not_installed_is_refused_with_how_to_get_it(
    encounter: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shutil.which", lambda _: None)
    with pytest.raises(AirhiltError, match="'flite': it is not installed; expected apt install"):
        check_given(encounter, Options(tts="flite"))
