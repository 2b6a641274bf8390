"""An experiment with one participant at the page: trials, breaks, and questionnaires.

Each participant has a folder, with a run folder and the answers of each trial. What is finished is
not run again; what was stopped is begun again in another folder, and stays.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from airhilt.errors import RunFolderError, StationError
from airhilt.files import read_inside, replace_file
from airhilt.messages import NasaTlx
from airhilt.options import options_of
from airhilt.record import RunFolder
from airhilt.scenario import loading
from airhilt.station.plan import Plan, Trial
from airhilt.station.started_runs import LARGEST_RECORD_BYTES, StartedRun, StartedRuns
from airhilt.text import readable

MOST_ATTEMPTS = 100
"""Largest number of times that a trial is begun."""


class Progress:
    """Trials that a participant has done so far, as the folder says.

    Parameters
    ----------
    folder
        Folder of the experiment.
    """

    def __init__(self, plan: Plan, folder: Path, participant: str) -> None:
        self.plan = plan
        self.participant = participant
        self.folder = folder / participant
        self.trials = plan.order(participant)

    def attempts(self, trial: Trial) -> Iterator[str]:
        """Yield the names of the run folders of a trial that may be there, in their order."""
        position = self.trials.index(trial) + 1
        for number in range(1, MOST_ATTEMPTS):
            yield f"{position:02d}-{trial.name}" + (f"-{number}" if number > 1 else "")

    def finished_run(self, trial: Trial) -> str | None:
        """Return the name of the run folder of a trial that its participant has done.

        Its run has ended by itself, and somebody had the seat.
        """
        for name in self.attempts(trial):
            folder = self.folder / name
            if not folder.exists():
                return None
            try:
                run = RunFolder.open(folder)
                if run.info().phase == "finished" and not _nobody_sat(run):
                    return name
            except RunFolderError:
                continue
        return None

    def new_run(self, trial: Trial) -> str:
        """Return the name of a run folder that is not there yet.

        Raises
        ------
        StationError
            The trial was begun too often.
        """
        for name in self.attempts(trial):
            if not (self.folder / name).exists():
                return name
        raise StationError(f"trial {trial.name}: begun {MOST_ATTEMPTS} times; look at its folders")

    def answers(self, name: str) -> NasaTlx | None:
        """Return what was answered at the end of a run or after it, None if nothing was yet."""
        try:
            data = read_inside(self.folder, self._answers_path(name), LARGEST_RECORD_BYTES)
            return NasaTlx.model_validate_json(data)
        except (OSError, ValueError):
            return self._answers_in_run(name)

    def _answers_in_run(self, name: str) -> NasaTlx | None:
        try:
            summary = RunFolder(self.folder / name).summary() or {}
            (person,) = summary["people"]
            return NasaTlx.model_validate(person["workload"]["nasa_tlx"])
        except (RunFolderError, ValueError, LookupError, TypeError):
            return None

    def answer(self, name: str, answers: NasaTlx) -> None:
        """Keep what was answered after a run."""
        replace_file(self._answers_path(name), answers.model_dump_json(indent=2).encode())

    def is_done(self, trial: Trial) -> bool:
        """Return true if a trial has been run, and its questions answered."""
        name = self.finished_run(trial)
        return name is not None and (not self.plan.nasa_tlx or self.answers(name) is not None)

    def _answers_path(self, name: str) -> Path:
        return self.folder / f"{name}.nasa_tlx.json"


def _nobody_sat(run: RunFolder) -> bool:
    """Return true if the summary of a run says that its seats were never taken."""
    try:
        people = (run.summary() or {})["people"]
        return bool(people) and all(person["seat_time_s"] == 0.0 for person in people)
    except (RunFolderError, LookupError, TypeError):
        return False  # It cannot be known, as of a run of an earlier version.


class Conductor:
    """Leads one participant through the trials."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._started = StartedRuns(progress.folder)
        self._done = sum(map(progress.is_done, progress.trials))
        self._rested_since_s = time.monotonic() if self._done else None
        self._lock = threading.Lock()

    def state(self) -> dict[str, Any]:
        """Return what the page shows: which trial it is, and what is to be done."""
        with self._lock:
            return self._state()

    def begin(self) -> None:
        """Start the run of the next trial.

        Raises
        ------
        AirhiltError
            It is not time for it, or it cannot be run.
        """
        with self._lock:
            state, trial = self._state(), self._next()
            if trial is None or state["step"] != "ready" or state["rest_s"] > 0:
                raise StationError("it is not time for a trial")
            plan = self._progress.plan
            given = {**plan.options, **trial.conditions, "seat": (plan.seat,)}
            given["wait_for_seats"] = True
            given["pause"] = plan.pause
            given["nasa_tlx"] = plan.nasa_tlx
            given["run_name"] = f"Trial-{state['trial']}"  # It tells a participant nothing.
            name = self._progress.new_run(trial)
            self._started.start(loading.find(trial.scenario), options_of(given), name)

    def answer(self, answers: NasaTlx) -> None:
        """Take the answers after a trial.

        Raises
        ------
        StationError
            Nothing was asked.
        """
        with self._lock:
            trial = self._next()
            name = None if trial is None else self._progress.finished_run(trial)
            if name is None or self._progress.answers(name) is not None:
                raise StationError("no question is open")
            self._progress.answer(name, answers)

    def _state(self) -> dict[str, Any]:
        trials, trial = self._progress.trials, self._next()
        done = len(trials) if trial is None else trials.index(trial)
        if done > self._done:
            self._done, self._rested_since_s = done, time.monotonic()
        shown = {
            "participant": self._progress.participant,
            "seat": readable(self._progress.plan.seat),
            "trials": len(trials),
            "may_pause": self._progress.plan.pause,
            "rest_s": 0.0,
            "url": "",
            "said": "",
        }
        if trial is None:
            return shown | {"step": "done", "trial": len(trials)}
        position = trials.index(trial)
        shown["trial"] = position + 1
        if self._progress.finished_run(trial) is not None:
            return shown | {"step": "questions"}
        run = self._last_run()
        row = next((row for row in self._started.rows() if run and row["name"] == run.name), None)
        if row is not None and row["name"] in self._progress.attempts(trial):
            if row["state"] != "ended":
                return shown | {"step": row["state"], "url": row["url"]}
            shown["said"] = "The last run of this trial did not finish."
        return shown | {"step": "ready", "rest_s": self._rest_s(position)}

    def _next(self) -> Trial | None:
        return next((one for one in self._progress.trials if not self._progress.is_done(one)), None)

    def _last_run(self) -> StartedRun | None:
        return next(iter(self._started.runs()), None)

    def _rest_s(self, position: int) -> float:
        """Return how much of a break is left before a trial, in s."""
        plan = self._progress.plan
        if self._rested_since_s is None or not plan.break_after or position % plan.break_after:
            return 0.0
        return max(plan.break_minutes * 60.0 - (time.monotonic() - self._rested_since_s), 0.0)
