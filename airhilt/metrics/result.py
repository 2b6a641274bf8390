"""The result of a run: its numbers, its messages, and its data as frames of pandas."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from airhilt.errors import RunFolderError, first_problem
from airhilt.host.text import readable
from airhilt.messages import Message, decode
from airhilt.metrics import run_frames
from airhilt.metrics.summary import Summary
from airhilt.metrics.summary_rows import summary_rows
from airhilt.record import Run, RunFolder
from airhilt.record.damage import Notice, tell_damage

if TYPE_CHECKING:
    from pandas import DataFrame


class Result(Run):
    """A run that `airhilt.run` has made or `airhilt.open_run` has opened.

    Its frames have the time of the simulation as their index, ``t_s``, and units in the names of
    their columns; ``attrs`` has ``units`` and ``descriptions`` by name. A run without such messages
    gives an empty frame with the same columns. What is damaged in the log is left out.
    """

    def __init__(self, paths: RunFolder, summary: Summary | None = None) -> None:
        super().__init__(paths)
        if summary is not None:
            self.summary = summary

    @cached_property
    def summary(self) -> Summary:
        """The numbers of the run.

        It raises `RunFolderError` if they are missing, damaged, or of another version.
        """
        try:
            return Summary.model_validate(self.numbers())
        except ValidationError as error:
            raise RunFolderError(
                f"{self.paths.summary_path}: {first_problem(error)}; expected the numbers of this "
                "version of AIRHILT"
            ) from None

    def messages(self, key: str = "") -> Iterator[Message | dict[str, Any]]:
        """Yield the messages of a key and of all keys below it, in the order of the log.

        Messages of other packages, whose classes are not known here, are dictionaries. It raises
        `RunFolderError` if the log cannot be read, or is of another version.

        Parameters
        ----------
        key
            Such as ``asr``, ``asr/118300`` or ``truth/conflict``; empty for all of them.
        """
        for logged in self.log():
            if not key or logged.key == key or logged.key.startswith(f"{key}/"):
                try:
                    yield decode(logged.key, logged.data)
                except ValueError as error:
                    raise run_frames.of_another_version(self, logged.key, error) from None

    def states(self) -> DataFrame:
        """Return the true states of the actors: where they are, how fast, and their attitude."""
        return self._frame("states")

    def advisories(self) -> DataFrame:
        """Return the advisories, a row a revision and recipient."""
        return self._frame("advisories")

    def calls(self) -> DataFrame:
        """Return the calls as they were really said; ``id`` is that of their transcripts too."""
        return self._frame("calls")

    def transcripts(self) -> DataFrame:
        """Return the transcripts of the recognisers."""
        return self._frame("transcripts")

    def detections(self) -> DataFrame:
        """Return the objects that detectors found, a row an object and picture."""
        return self._frame("detections")

    def adsb(self) -> DataFrame:
        """Return the ADS-B reports."""
        return self._frame("adsb")

    def latencies(self) -> DataFrame:
        """Return the steps of the workers, at the times of their results."""
        return self._frame("latencies")

    def truth(self) -> DataFrame:
        """Return what happened: phases of conflicts, runways taken and left, and events."""
        return self._frame("truth")

    def frames(self) -> dict[str, DataFrame]:
        """Return all frames by the names of their methods, from one reading of the log."""
        return run_frames.read_frames(self, run_frames.FRAMES)

    def _frame(self, name: str) -> DataFrame:
        return run_frames.read_frames(self, (name,))[name]

    def __repr__(self) -> str:
        return f"<Result of {self.info.realised.get('name')} in {self.folder}>"

    def _repr_html_(self) -> str:
        """Return the numbers as a table, for notebooks."""
        try:
            rows = [*summary_rows(self.summary)]
        except RunFolderError as error:
            rows = [("numbers", str(error))]
        rows += [("damaged", line) for line in self.damage]
        rows.append(("run folder", str(self.folder)))
        cells = "".join(
            f'<tr><th style="text-align:left">{escape(readable(label))}</th>'
            f'<td style="text-align:left">{escape(readable(value))}</td></tr>'
            for label, value in rows
        )
        return f"<table>{cells}</table>"


def open_result(path: str | Path, notice: Notice | None = None) -> Result:
    """Open the folder of a run, else as `airhilt.record.open_run`."""
    result = Result(RunFolder.open(Path(path)))
    tell_damage(result.folder, result.damage, notice)
    return result
