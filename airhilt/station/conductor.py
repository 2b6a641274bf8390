"""The conductor of an experiment: leads participants through trials, breaks and questionnaires."""

from __future__ import annotations

import itertools
import threading
import time
from collections.abc import Sequence
from typing import Any

from airhilt.errors import StationError
from airhilt.host.text import readable
from airhilt.options import options_of
from airhilt.scenario import loading
from airhilt.station.participant_progress import Progress
from airhilt.station.questionnaires import Answers
from airhilt.station.started_runs import PAGE_OF_THIS_MACHINE, StartedRuns


class Conductor:
    """Leads a participant through the trials, or those who have the seats of a trial together.

    Parameters
    ----------
    team
        Progress of each of them, in the order of the seats.
    page
        Arguments that the pages of the trials have, as `StartedRuns` takes them.
    """

    def __init__(
        self, team: Sequence[Progress], page: Sequence[str] = PAGE_OF_THIS_MACHINE
    ) -> None:
        self._team = {progress.participant: progress for progress in team}
        self._plan, self._trials = team[0].plan, team[0].trials
        self._started = StartedRuns(team[0].folder, page)
        self._done = self._trials_done()
        self._rested_since_s = time.monotonic() if self._done else None
        self._lock = threading.Lock()

    def state(self, participant: str = "") -> dict[str, Any]:
        """Return what the page of a participant shows: which trial it is, and what is to be done.

        Parameters
        ----------
        participant
            Empty: who alone is led; of several, the page lets its reader choose.

        Raises
        ------
        AirhiltError
            Nobody of that name is led, or answers cannot be read.
        """
        with self._lock:
            return self._state(participant)

    def begin(self, participant: str = "") -> None:
        """Start the run of the next trial, unless somebody of the team has just begun it.

        Raises
        ------
        AirhiltError
            It is not time for it, or it cannot be run.
        """
        with self._lock:
            state, done = self._state(participant), self._trials_done()
            if state["step"] in ("starting", "running"):
                return
            if state["step"] != "ready" or state["rest_s"] > 0:
                raise StationError("it is not time for a trial")
            plan, trial = self._plan, self._trials[done]
            given = {**plan.options, **trial.conditions, "seat": plan.all_seats}
            given["pause"] = plan.pause
            given["nasa_tlx"] = plan.nasa_tlx
            given["run_name"] = f"Trial-{state['trial']}"  # It tells a participant nothing.
            name = self._progress(participant).new_run(trial)
            scenario = loading.find(trial.scenario)
            self._started.start(scenario, options_of(given), name)

    def answer(self, name: str, answers: Answers, participant: str = "") -> None:
        """Take the answers of a participant to a questionnaire.

        Raises
        ------
        StationError
            It is not asked now, or these are not answers to it.
        """
        with self._lock:
            progress = self._progress(participant)
            asked = progress.asked()
            if asked is None or asked.questionnaire.name != name:
                raise StationError(f"{readable(name)}: no question of it is open")
            progress.answer(asked, answers)

    def _progress(self, participant: str) -> Progress:
        """Return the progress of a participant; empty: of who alone is led."""
        found = self._team.get(participant)
        if found is None and not participant and len(self._team) == 1:
            (found,) = self._team.values()
        if found is None:
            raise StationError(
                f"participant {readable(participant)!r}: not of these trials; expected one of "
                f"{', '.join(self._team)}"
            )
        return found

    def _trials_done(self) -> int:
        """Return the number of trials that everybody has done: they are the first ones."""
        team = self._team.values()
        done = (all(one.is_done(trial) for one in team) for trial in self._trials)
        return sum(itertools.takewhile(bool, done))

    def _state(self, participant: str) -> dict[str, Any]:
        trials, done = self._trials, self._trials_done()
        if done > self._done:
            self._done, self._rested_since_s = done, time.monotonic()
        shown: dict[str, Any] = {"trials": len(trials), "trial": min(done + 1, len(trials))}
        if not participant and len(self._team) > 1:
            seats = {name: readable(self._plan.seat_of(name)) for name in self._team}
            return shown | {"step": "choose", "seats": seats}
        progress = self._progress(participant)
        shown |= {
            "participant": progress.participant,
            "seat": readable(self._plan.seat_of(progress.participant)),
            "together": len(self._team) > 1,
            "may_pause": self._plan.pause,
            "rest_s": 0.0,
            "url": "",
            "said": "",
        }
        asked = progress.asked()
        if asked is not None:
            return shown | {"step": "questions", "questions": asked.questionnaire.document()}
        if progress.next_trial() is None:
            return shown | {"step": "done"}
        if any(other.asked() is not None for other in self._team.values()):
            return shown | {"step": "waiting"}
        run = next(iter(self._started.runs()), None)
        if run is not None and run.name in progress.attempts(trials[done]):
            if (doing := self._started.state(run)) != "ended":
                own = readable(progress.seat(trials[done]))
                url = self._started.url(run) if doing == "running" else ""
                return shown | {"step": doing, "url": url, "seat": own}
            shown["said"] = "The last run of this trial did not finish."
        return shown | {"step": "ready", "rest_s": self._rest_s(done)}

    def _rest_s(self, position: int) -> float:
        """Return how much of a break is left before a trial, in s."""
        plan = self._plan
        if self._rested_since_s is None or not plan.break_after or position % plan.break_after:
            return 0.0
        return max(plan.break_minutes * 60.0 - (time.monotonic() - self._rested_since_s), 0.0)
