"""A recorded run: its folder, read and checked against its manifest."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any

from airhilt.errors import RunFolderError
from airhilt.host import bounded_json
from airhilt.record.damage import Notice, tell_damage
from airhilt.record.folder import RunFolder, RunInfo
from airhilt.record.latency import RecordedLatencies, read_latencies
from airhilt.record.log_reader import Logged, LogReader, gaps_text
from airhilt.record.manifest import digest_problem, problem_of
from airhilt.units import SECOND_NS


class Run:
    """A run folder whose files that commands read have been compared with its manifest."""

    def __init__(self, paths: RunFolder) -> None:
        self.paths = paths
        self.info: RunInfo = paths.info()

    @property
    def folder(self) -> Path:
        """The run folder."""
        return self.paths.path

    @cached_property
    def log_damage(self) -> str:
        """From when to when the log is damaged, empty if it is not."""
        return _log_problem(self.paths, self.info)

    @cached_property
    def damage(self) -> tuple[str, ...]:
        """A line for each file that commands read and that is not as the run wrote it.

        These are ``run.json``, the log, the latencies and the summary; sound, pictures and videos
        are not among them.
        """
        lines = (
            _info_problem(self.paths),
            self.log_damage,
            *(self._problem(path) for path in (self.paths.latency_path, self.paths.summary_path)),
        )
        return tuple(filter(None, lines))

    def damage_of_all_files(self) -> tuple[str, ...]:
        """Return `damage`, and a line for each other file of the manifest that was changed."""
        folder = self.paths
        checked = {folder.log_path.name, folder.latency_path.name, folder.summary_path.name}
        lines = (
            problem_of(folder.path, name, record)
            for name, record in self.info.files.items()
            if name not in checked
        )
        return (*self.damage, *filter(None, lines))

    def log(self) -> Iterator[Logged]:
        """Yield the messages of the log without what is damaged; else as `LogReader.messages`."""
        return LogReader(self.paths.log_path).messages()

    def steps(self) -> RecordedLatencies:
        """Return the steps of the workers.

        It raises `RunFolderError` if they cannot be read, or are not those that the run wrote.
        """
        if problem := self._problem(self.paths.latency_path):
            raise RunFolderError(
                f"{self.folder}: {problem}; expected the latencies that the run had"
            )
        return read_latencies(self.paths.latency_path)

    def numbers(self) -> dict[str, Any]:
        """Return the numbers of the run, the content of ``summary.json``.

        It raises `RunFolderError` if they cannot be read, or are not those that the run wrote.
        """
        path = self.paths.summary_path
        problem = self._problem(path)
        numbers = None if problem else self.paths.summary()
        if numbers is None:
            raise RunFolderError(
                f"{self.folder}: {problem or f'{path.name}: missing'}; expected the numbers "
                "of the run"
            )
        return numbers

    def _problem(self, path: Path) -> str:
        record = self.info.files.get(path.name)
        return "" if record is None else problem_of(self.folder, path.name, record)


def open_run(path: str | Path, notice: Notice | None = None) -> Run:
    """Open the folder of a run that has ended, was killed, or is still going on.

    The notice is told each line of the run's ``damage``; None warns of it, as Python does. It
    raises `RunFolderError` if there is no run in it, or its ``run.json`` cannot be read.
    """
    run = Run(RunFolder.open(Path(path)))
    tell_damage(run.folder, run.damage, notice)
    return run


def result_problem(folder: RunFolder, info: RunInfo, path: Path) -> str:
    """Return in words why a file is not one that the run wrote, empty if it is.

    A run that goes on or was killed has no record of its pictures and videos.
    """
    name = path.relative_to(folder.path).as_posix()
    record = info.files.get(name)
    if record is not None:
        return problem_of(folder.path, name, record)
    return "" if info.phase == "running" else f"{name}: not written by the run"


def _info_problem(folder: RunFolder) -> str:
    try:
        document = bounded_json.parse(folder.read(folder.info_path))
    except (OSError, ValueError):
        document = {}
    return digest_problem(folder.info_path.name, document)


def _log_problem(folder: RunFolder, info: RunInfo) -> str:
    """Return in words from when to when the log is damaged, empty if it is not.

    A log without a record, because its run was killed or goes on, is checked by its own checksums.
    """
    path = folder.log_path
    record = info.files.get(path.name)
    if record is not None and not problem_of(folder.path, path.name, record):
        return ""
    reader = LogReader(path)
    try:
        for _ in reader.messages():
            pass
    except RunFolderError as error:
        if record is None:
            return ""
        return str(error).replace(str(path), path.name)
    if reader.gaps:
        return f"{path.name}: {gaps_text(reader.gaps)}; the rest is read"
    if record is None:
        return ""
    if not reader.is_closed:
        ended = f"{reader.end_ns / SECOND_NS:.3f} s"
        return f"{path.name}: damaged from {ended} to its end: it breaks off there"
    if reader.is_faultless():
        return (
            f"{path.name}: changed after the run: its own checksums are right, but its SHA-256 is "
            "not that in run.json"
        )
    return f"{path.name}: damaged outside of its messages, all of which are read"
