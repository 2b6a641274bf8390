"""Whoever starts a run from Python may give it workers of the same process."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt import Input, Output, Scenario, Step
from airhilt.cosim.observer import Observer
from airhilt.cosim.replay import replay
from airhilt.errors import RunStopped, WorkerError
from airhilt.messages import Advisory, Evidence, InputSpec, Severity, WorkerDescription
from airhilt.record import RunFolder, read_log

DESCRIPTORS = Path("/proc/self/fd")


class WarnsOnce:
    """Warns one crew, as soon as it hears of an aircraft."""

    description = WorkerDescription(
        name="warner", modality="decision", inputs=(InputSpec(key="adsb/*", policy="batch"),)
    )

    def __init__(self) -> None:
        self._told = False

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Return the one advisory."""
        if self._told:
            return Step()
        self._told = True
        advisory = Advisory(
            id="warner-1", recipient="AAL123", severity=Severity.CAUTION, kind="loss_of_separation",
            traffic=("AAL123", "DAL456"), message="traffic ahead", t_ready_ns=t_ns, revision=0,
            recipients=("AAL123",), evidence=Evidence(sources=("adsb",)),
        )  # fmt: skip
        return Step((Output("advisory/AAL123", advisory.model_dump_json().encode()),))


def test_a_worker_of_the_caller_takes_the_place_of_the_reference_worker(
    encounter: Scenario, tmp_path: Path
) -> None:
    result = airhilt.run(
        encounter, out=tmp_path / "run", observer=Observer(), workers=[WarnsOnce()],
        latency="fixed", speech=False, cameras=False,
    )  # fmt: skip
    publishers = {one.publisher for one in read_log(result.folder / "log.mcap")}
    assert "warner" in publishers
    assert "decision" not in publishers
    assert result.summary.assistant == "external"
    assert [one.id for one in result.summary.advisories] == ["warner-1"]
    assert [one.where for one in RunFolder(result.folder).info().workers] == ["caller"]


@pytest.mark.parametrize("options", [{}, {"speech": True}, {"seat": ("AAL123",)}])
def test_a_run_keeps_nobody_when_it_has_ended(
    options: dict[str, Any], encounter: Scenario, tmp_path: Path
) -> None:
    """Its parts do not refer to each other in circles, so nothing waits for the collector."""
    worker, observer = WarnsOnce(), Observer()
    kept = [weakref.ref(worker), weakref.ref(observer)]
    gc.disable()
    try:
        airhilt.run(
            encounter, out=tmp_path / "run", workers=[worker], observer=observer, cameras=False,
            **{"latency": "fixed", "speech": False, "pace": "virtual", **options},
        )  # fmt: skip
        del worker, observer
        assert [reference() for reference in kept] == [None, None]
    finally:
        gc.enable()


def test_its_run_replays_from_the_record_without_it(encounter: Scenario, tmp_path: Path) -> None:
    folder = airhilt.run(
        encounter, out=tmp_path / "run", observer=Observer(), workers=[WarnsOnce()], speech=False,
        cameras=False,
    ).folder  # fmt: skip
    assert replay(folder).identical


def test_two_workers_of_which_one_could_write_the_ids_of_the_other_are_refused(
    encounter: Scenario, tmp_path: Path
) -> None:
    other = WarnsOnce()
    other.description = other.description.model_copy(update={"name": "warner-b"})
    with pytest.raises(WorkerError, match="'warner' and 'warner-b': an id that begins with"):
        airhilt.run(encounter, out=tmp_path / "run", workers=[other, WarnsOnce()])
    assert not (tmp_path / "run").exists()


def test_python_warns_of_a_worker_that_crashes_and_a_strict_run_stops(
    encounter: Scenario, tmp_path: Path
) -> None:
    class Crashes(WarnsOnce):
        def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
            raise KeyError("nobody")

    options: dict[str, Any] = {"latency": "fixed", "speech": False, "cameras": False}
    with pytest.warns(RuntimeWarning, match="lost at .* worker 'warner' failed: KeyError"):
        airhilt.run(encounter, out=tmp_path / "run", workers=[Crashes()], **options)
    with pytest.warns(RuntimeWarning), pytest.raises(RunStopped, match="as --strict asks"):
        airhilt.run(encounter, out=tmp_path / "b", workers=[Crashes()], strict=True, **options)


def test_what_is_no_worker_is_refused(encounter: Scenario, tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match=r"expected an airhilt\.messages\.WorkerDescription"):
        airhilt.run(encounter, out=tmp_path / "run", workers=[object()])  # type: ignore[list-item]


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        (((), 0.33e9 + 0.5), "worker 'warner' returned a Step with wake_ns 330000000.5"),
        ((("x",),), "worker 'warner' returned 'x' among its outputs"),
    ],
)
def test_a_step_with_a_part_of_another_type_ends_the_run_and_its_folder_is_complete(
    encounter: Scenario, tmp_path: Path, parts: tuple[Any, ...], words: str
) -> None:
    class Odd(WarnsOnce):
        def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
            return Step(*parts)

    with pytest.raises(WorkerError, match=words):
        airhilt.run(encounter, out=tmp_path / "run", workers=[Odd()], speech=False, cameras=False)
    folder = RunFolder(tmp_path / "run")
    assert folder.info().phase == "stopped"
    assert words in (folder.summary() or {})["outcome"]


@pytest.mark.parametrize("assistant", ["none", "reference"])
def test_another_assistant_beside_a_worker_that_decides_is_refused(
    encounter: Scenario, tmp_path: Path, assistant: str
) -> None:
    with pytest.raises(
        WorkerError, match=f"assistant '{assistant}', but a worker of yours decides; expected one"
    ):
        airhilt.run(encounter, out=tmp_path / "run", assistant=assistant, workers=[WarnsOnce()])
    assert not (tmp_path / "run").exists()


@pytest.mark.skipif(not DESCRIPTORS.is_dir(), reason="open files are listed on Linux only")
def test_a_run_that_refuses_a_worker_leaves_no_file_open(
    encounter: Scenario, tmp_path: Path
) -> None:
    class Cheat(WarnsOnce):
        description = WorkerDescription(
            name="cheat", modality="decision", inputs=(InputSpec(key="truth/*", policy="batch"),)
        )

    # The error keeps the frames of the run alive, so nothing is closed by chance.
    with pytest.raises(WorkerError, match="truth never reaches a worker") as refused:
        airhilt.run(encounter, out=tmp_path / "run", workers=[Cheat()], speech=False, cameras=False)
    assert (tmp_path / "run" / "latency.jsonl").is_file()
    assert [path for path in open_files() if path.is_relative_to(tmp_path)] == []
    del refused


def open_files() -> list[Path]:
    """Return what the descriptors of this process lead to."""
    return [link.readlink() for link in list(DESCRIPTORS.iterdir()) if link.is_symlink()]
