"""Sensors are found by their name: files of the package, and entry points of other packages."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader

import airhilt
from airhilt.cosim.replay import replay
from airhilt.errors import ScenarioError, SensorError, WorkerError
from airhilt.messages import BUS_MESSAGES, InputSpec, WorkerDescription
from airhilt.record import RunFolder, read_log
from airhilt.scenario import Scenario
from airhilt.sensors.base import load_sensor_types, sensor_messages
from airhilt.sim.worker import Input
from airhilt.workers import Step
from airhilt.world.loading import load_text
from paths import ROOT
from shortened import shortened

GUIDE = (ROOT / "docs" / "adding-a-sensor.md").read_text()


def block(language: str) -> str:
    """Return the first block of the guide in a language."""
    found = re.search(rf"```{language}\n(.*?)```", GUIDE, flags=re.DOTALL)
    assert found is not None
    return found[1]


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The sensor that the guide shows, in a package that is installed beside AIRHILT."""
    package = tmp_path / "my_package"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "loop.py").write_text(block("python"))
    metadata = tmp_path / "my_package-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: my-package\nVersion: 1.0\n")
    _, line = block("toml").splitlines()
    (metadata / "entry_points.txt").write_text(f"[airhilt.sensors]\n{line.replace(chr(34), '')}\n")
    monkeypatch.syspath_prepend(tmp_path)
    yield package
    for name in [name for name in sys.modules if name.split(".")[0] == "my_package"]:
        del sys.modules[name]


@pytest.fixture
def scenario(encounter: Scenario) -> Scenario:
    """Five seconds of the encounter, and a loop in the pavement."""
    document = shortened(encounter.model_dump(mode="json"), 5.0)
    document["sensors"] = json.loads(block("json"))
    return load_text(json.dumps(document), "encounter")


class Subscriber:
    """A worker that keeps what it gets on ``loop/*``."""

    description = WorkerDescription(
        name="subscriber", modality="decision", inputs=(InputSpec(key="loop/*"),)
    )

    def __init__(self) -> None:
        self.inputs: list[Input] = []

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        self.inputs += inputs
        return Step()


def go(
    scenario: Scenario, folder: Path, worker: Subscriber | None = None
) -> list[tuple[str, dict[str, object]]]:
    """Run, and return the messages on ``loop/...``."""
    workers = [] if worker is None else [worker]
    airhilt.run(scenario, out=folder, latency="fixed", cameras=False, speech=False, workers=workers)
    log = read_log(folder / "log.mcap")
    return [(m.key, json.loads(m.data)) for m in log if m.key.startswith("loop/")]


def test_a_sensor_of_another_package_is_logged_with_its_schema(
    installed: Path, scenario: Scenario, tmp_path: Path
) -> None:
    measured = go(scenario, tmp_path / "run")
    assert len(measured) == 6
    assert all(key == "loop/1" and not state["occupied"] for key, state in measured)
    with (tmp_path / "run" / "log.mcap").open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    schema_id = next(c.schema_id for c in summary.channels.values() if c.topic == "loop/1")
    assert summary.schemas[schema_id].name == "airhilt.LoopState"
    assert "occupied" in json.loads(summary.schemas[schema_id].data)["properties"]


def test_raw_bytes_reach_the_worker_with_their_header(
    installed: Path, scenario: Scenario, tmp_path: Path
) -> None:
    source = (installed / "loop.py").read_text()
    source = source.replace("import Message", "import Header").replace("(Message)", "(Header)")
    source = source.replace('publish("loop/1", state)', 'publish("loop/1", state, raw=bytes(3))')
    (installed / "loop.py").write_text(source)
    worker = Subscriber()
    assert go(scenario, tmp_path / "run", worker)
    assert {item.payload for item in worker.inputs} == {bytes(3)}
    assert all(item.attachment["occupied"] is False for item in worker.inputs)


WATCHFUL = """
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision
from airhilt.engines import Engine
from airhilt.messages import Evidence, Severity
from my_package.loop import LoopState


class Watchful:
    name, reads = "watchful", ()
    inputs = {"loop/*": LoopState}

    def __init__(self):
        self.states = 0

    def receive(self, received):
        self.states += isinstance(received.message, LoopState) and not received.message.occupied

    def decide(self, t_ns):
        return Decision([self.alert()] if self.states == 3 else [])

    def alert(self):
        return Alert(
            id="loop", revision=0, kind="runway_conflict", severity=Severity.ADVISORY,
            recipients=("ATC",), traffic=(), evidence=Evidence(sources=("loop",), note="free"),
        )


ENGINE = Engine("watchful", "watches the loop", lambda _: Watchful())
"""


def decide_by(source: str, installed: Path, scenario: Scenario, folder: Path) -> list[str]:
    """Run with an assistant of the same package, and return the keys of what it tells."""
    (installed / "watchful.py").write_text(source)
    points = installed.parent / "my_package-1.0.dist-info" / "entry_points.txt"
    points.write_text(
        f"{points.read_text()}\n[airhilt.assistants]\nwatchful = my_package.watchful:ENGINE\n"
    )
    airhilt.run(
        scenario, out=folder, latency="fixed", cameras=False, speech=False, assistant="watchful"
    )
    log = read_log(folder / "log.mcap")
    return [m.key for m in log if m.key.startswith("advisory/")]


def test_an_assistant_of_another_package_decides_by_it(
    installed: Path, scenario: Scenario, tmp_path: Path
) -> None:
    assert decide_by(WATCHFUL, installed, scenario, tmp_path / "run")[:1] == ["advisory/ATC"]
    assert replay(tmp_path / "run").identical


def test_no_assistant_names_truth_as_an_input(
    installed: Path, scenario: Scenario, tmp_path: Path
) -> None:
    cheating = WATCHFUL.replace("loop/*", "truth/state/*")
    with pytest.raises(WorkerError, match="'decision' asks for 'truth/state/"):
        decide_by(cheating, installed, scenario, tmp_path / "run")


def test_run_json_names_the_package_of_the_sensor(
    installed: Path, scenario: Scenario, tmp_path: Path
) -> None:
    go(scenario, tmp_path / "run")
    info = RunFolder(tmp_path / "run").info()
    assert info.other_packages == {"sensor loop": "my-package 1.0"}


def test_it_rests_where_the_scenario_does_not_ask_for_it(
    installed: Path, encounter: Scenario, tmp_path: Path
) -> None:
    short = encounter.model_copy(update={"duration_s": 2.0})
    assert go(short, tmp_path / "run") == []


def test_a_sensor_may_be_there_because_a_worker_subscribes_to_its_keys(
    installed: Path, encounter: Scenario, tmp_path: Path
) -> None:
    needed = "Loop(context) if self.name in context.subscribed else None"
    replace_in(installed, "None if context.settings is None else Loop(context)", needed)
    replace_in(installed, "any(self.carries(actor.body) for actor in", "not any(False for _ in")
    replace_in(installed, "[math.radians(context.settings[name])", "[name")
    short = encounter.model_copy(update={"duration_s": 2.0})
    assert go(short, tmp_path / "alone") == []
    worker = Subscriber()
    assert len(go(short, tmp_path / "asked for", worker)) == 3
    assert len(worker.inputs) >= 2
    assert replay(tmp_path / "asked for").identical


def test_its_messages_are_among_the_schemas(installed: Path) -> None:
    assert sensor_messages(load_sensor_types()[0])["loop/{name}"].__name__ == "LoopState"


def test_settings_for_a_sensor_that_is_not_installed_are_refused(
    encounter: Scenario, tmp_path: Path
) -> None:
    asking = encounter.model_copy(update={"sensors": {"adbs": {}}})
    with pytest.raises(ScenarioError, match="no sensor named 'adbs'; did you mean 'adsb'"):
        go(asking, tmp_path / "run")


def test_settings_that_the_sensor_does_not_take_are_named(
    installed: Path, scenario: Scenario, tmp_path: Path
) -> None:
    asking = scenario.model_copy(update={"sensors": {"loop": {"lat": 38.85}}})
    with pytest.raises(SensorError, match=r"'loop' cannot be made .* KeyError: 'lat_deg'"):
        go(asking, tmp_path / "run")


def test_a_sensor_publishes_on_no_key_but_its_own(
    installed: Path, scenario: Scenario, tmp_path: Path
) -> None:
    source = installed / "loop.py"
    source.write_text(source.read_text().replace('publish("loop/1"', 'publish("truth/1"'))
    with pytest.raises(SensorError, match="'loop' published on 'truth/1'"):
        go(scenario, tmp_path / "run")


def replace_in(installed: Path, old: str, new: str) -> None:
    """Change the source of the sensor."""
    source = installed / "loop.py"
    assert old in source.read_text()
    source.write_text(source.read_text().replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("else Loop(context)", "else object()", "what it makes, <object .* has no start, unfinis"),
        (
            "    def start(self):\n",
            "    def start(self):\n        {}['gain']\n",
            r"'loop' does not start: KeyError: 'gain' \(loop.py, line 2\d\)",
        ),
        (
            "    def measure(self):\n",
            "    def measure(self):\n        self.context.director.now_ns >= 2e9 and {}['gain']\n",
            r"'loop' failed at 2\.0 s: KeyError: 'gain' \(loop.py, line 2\d\)",
        ),
        (
            "return ()",
            "return {}['gain']",
            "'loop' cannot say what is unfinished: KeyError: 'gain'",
        ),
        ("return ()", "return None", "'loop' cannot say what is unfinished: TypeError"),
    ],
)
def test_a_sensor_that_fails_is_named_and_the_run_folder_is_whole(
    installed: Path, scenario: Scenario, tmp_path: Path, old: str, new: str, told: str
) -> None:
    replace_in(installed, old, new)
    with pytest.raises(SensorError, match=told):
        go(scenario, tmp_path / "run")
    folder = RunFolder(tmp_path / "run")
    info, summary = folder.info(), folder.summary()
    assert (info.phase, "log.mcap" in info.files) == ("stopped", True)
    assert "'loop'" in info.cause
    assert summary is not None
    assert summary["outcome"] == f"stopped: {info.cause}"
    assert folder.report_path.exists()


def test_a_sensor_that_fails_twice_is_told_twice(
    installed: Path, scenario: Scenario, tmp_path: Path
) -> None:
    replace_in(installed, "    def measure(self):\n", "    def measure(self):\n        1 / 0\n")
    replace_in(installed, "return ()", "return {}['gain']")
    observer = Listening()
    with pytest.raises(SensorError, match=r"'loop' failed at 0\.0 s: ZeroDivisionError"):
        airhilt.run(
            scenario, out=tmp_path / "run", latency="fixed", cameras=False, speech=False,
            observer=observer,
        )  # fmt: skip
    assert "failed as well, when the run was finished: sensor 'loop'" in observer.notices[-1]
    assert "ZeroDivisionError" in RunFolder(tmp_path / "run").info().cause


def test_a_package_that_cannot_be_loaded_is_named_with_the_cause(
    installed: Path, scenario: Scenario, tmp_path: Path
) -> None:
    (installed / "loop.py").write_text("import no_such_module\n")
    with pytest.raises(SensorError, match=r"my_package\.loop:SENSOR: ModuleNotFoundError"):
        go(scenario, tmp_path / "run")


class Listening(airhilt.Observer):
    """An observer that keeps the notices."""

    def __init__(self) -> None:
        self.notices: list[str] = []

    def notice(self, text: str) -> None:
        self.notices.append(text)


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        (lambda _: "import no_such_module\n", "ModuleNotFoundError: No module named"),
        (lambda _: "raise SystemExit('it ends')\n", "SystemExit: it ends"),
        (lambda text: text.replace('"loop/{name}"', '"truth/{name}"'), "expected loop/..."),
        (lambda text: text.replace(": LoopState}", ": 42}"), "expected a Message"),
        (lambda text: text.replace('{"loop/{name}": LoopState}', "42"), "TypeError: 'int' object"),
    ],
)
def test_a_broken_sensor_that_nobody_asked_for_is_a_notice(
    installed: Path,
    encounter: Scenario,
    tmp_path: Path,
    airhilt_command: Any,
    change: Callable[[str], str],
    cause: str,
) -> None:
    source = installed / "loop.py"
    source.write_text(change(source.read_text()))
    observer = Listening()
    short = encounter.model_copy(update={"duration_s": 2.0})
    airhilt.run(
        short, out=tmp_path / "run", latency="fixed", cameras=False, speech=False, observer=observer
    )
    (notice,) = observer.notices
    assert "sensor 'loop'" in notice
    assert cause in notice
    schema = airhilt_command("schema")
    assert schema.returncode == 0
    assert "LoopState" not in schema.stdout
    assert schema.stderr == f"airhilt: {notice}\n"


def test_the_sensors_of_airhilt_declare_what_is_on_the_bus() -> None:
    own = sensor_messages(load_sensor_types()[0])
    assert {key: BUS_MESSAGES[key] for key in own} == own
