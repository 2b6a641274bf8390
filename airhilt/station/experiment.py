"""An experiment with people at the page: trials, breaks, and questionnaires.

Each participant has a folder, with a run folder and the answers of each trial. Participants who
have seats in the same trials share the run folders, in the folder of their team, and each has a
folder in it for the own answers. What is finished is not run again; what was stopped is begun again
in another folder, and stays.
"""

from __future__ import annotations

import itertools
import json
import threading
import time
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import TypeAdapter, ValidationError

from airhilt.errors import RunFolderError, StationError, first_problem
from airhilt.files import make_folder, read_inside, replace_file
from airhilt.messages import NasaTlx
from airhilt.options import options_of
from airhilt.record import RunFolder
from airhilt.scenario import loading
from airhilt.scenario.seats import seats_of
from airhilt.station.file_cache import FileCache
from airhilt.station.plan import Plan, Trial
from airhilt.station.questionnaires import NASA_TLX, Answers, Questionnaire
from airhilt.station.started_runs import (
    LARGEST_RECORD_BYTES,
    PAGE_OF_THIS_MACHINE,
    StartedRun,
    StartedRuns,
)
from airhilt.text import readable
from airhilt.world.loading import load

MOST_ATTEMPTS = 100
"""Largest number of times that a trial is begun."""


TOGETHER = "+"
"""Text between the participants of a team in the name of their folder; no identifier has it."""
KEPT_ANSWERS = TypeAdapter(Answers)
_SeatTimes = dict[str, float | None]
"""Times by seat, in s."""


class Asked(NamedTuple):
    """A questionnaire that is asked, and the run folder of the trial after which it is.

    Attributes
    ----------
    run
        Name of the run folder; empty: it is not asked after a trial.
    """

    questionnaire: Questionnaire
    run: str = ""


class Progress:
    """Trials that a participant has done so far, as the folder says.

    Parameters
    ----------
    folder
        Folder of the experiment.

    Attributes
    ----------
    folder
        Folder of the runs of the participant, or of the team.

    Raises
    ------
    RunFolderError
        The folder of the team is there with its participants in another order.
    """

    def __init__(self, plan: Plan, folder: Path, participant: str) -> None:
        team = plan.team_of(participant)
        self.plan = plan
        self.participant = participant
        self.folder = folder / TOGETHER.join(team)
        self.trials = plan.order(participant)
        self._number = team.index(participant)
        self._seats: dict[str, tuple[str, ...]] = {}
        self._times_s = FileCache[_SeatTimes | None]()
        self._kept_answers = FileCache[Answers | None]()
        self._answers = self.folder if len(team) == 1 else self.folder / participant
        _refuse_another_order(team, self.folder)

    def seat(self, trial: Trial) -> str:
        """Return the unit or callsign whose seat the participant has in a trial."""
        return self._all_seats(trial)[self._number]

    def require_same_seats(self, trial: Trial, name: str, had: Sequence[str]) -> None:
        """Complain about a run of a trial in which the seats were others than in the plan.

        Parameters
        ----------
        name
            Name of the run folder.
        had
            Seats that it had, in the order of the participants.

        Raises
        ------
        RunFolderError
            They were others, or in another order: who had which seat is not known.
        """
        seats = self._all_seats(trial)
        if tuple(had) != seats:
            were = "its seats were" if len(seats) > 1 else "its seat was"
            raise RunFolderError(
                f"{self.folder / name}: {were} {readable(', '.join(had))}; expected "
                f"{', '.join(seats)}, as the plan has them now; put them back in the plan, or run "
                "the changed plan in another folder"
            )

    def _all_seats(self, trial: Trial) -> tuple[str, ...]:
        """Return the units and callsigns of the seats of a trial, in the order of the team."""
        found = self._seats.get(trial.scenario)
        if found is None:
            found = seats_of(self.plan.all_seats, load(loading.find(trial.scenario)))
            self._seats[trial.scenario] = found
        return found

    def attempts(self, trial: Trial) -> Iterator[str]:
        """Yield the names of the run folders of a trial that may be there, in their order."""
        position = self.trials.index(trial) + 1
        for number in range(1, MOST_ATTEMPTS):
            yield f"{position:02d}-{trial.name}" + (f"-{number}" if number > 1 else "")

    def finished_run(self, trial: Trial) -> str | None:
        """Return the name of the run folder of a trial that its participant has done.

        Its run has ended by itself, and somebody had the seat, or each of its seats.

        Raises
        ------
        RunFolderError
            Its seats were others than those of the plan.
        """
        for name in self.attempts(trial):
            folder = self.folder / name
            if not folder.exists():
                return None
            times_s = self._times_of(RunFolder(folder))
            if times_s:
                self.require_same_seats(trial, name, list(times_s))
            if times_s is not None and 0.0 not in times_s.values():
                return name
        return None

    def _times_of(self, run: RunFolder) -> _SeatTimes | None:
        """Return how long the seats of a run were taken, None if it has not ended by itself."""

        def read() -> _SeatTimes | None:
            try:
                return _seat_times_s(run) if run.info().phase == "finished" else None
            except RunFolderError:
                return None

        return self._times_s.get(read, run.info_path, run.summary_path)

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

    def answers(self, questionnaire: Questionnaire, run: str = "") -> Answers | None:
        """Return what was answered, None if nothing was yet.

        Parameters
        ----------
        run
            Name of the run folder of a trial after which it is asked; empty: it is not asked after
            a trial.

        Raises
        ------
        RunFolderError
            The file of the answers cannot be read, or has an answer that the item does not take. An
            item without an answer is none: it may have come into the plan later.
        """
        read = partial(self._read_answers, questionnaire, run)
        rated = RunFolder(self.folder / run).summary_path
        return self._kept_answers.get(read, self._path(questionnaire, run), rated)

    def _read_answers(self, questionnaire: Questionnaire, run: str) -> Answers | None:
        path = self._path(questionnaire, run)
        try:
            found = KEPT_ANSWERS.validate_json(read_inside(self.folder, path, LARGEST_RECORD_BYTES))
            asked = [item for item in questionnaire.items if item.name in found]
            for item in asked:
                item.check(found[item.name])
        except FileNotFoundError:
            return self._rated_at_seat(run) if questionnaire == NASA_TLX else None
        except OSError as error:
            raise _no_answers(path, str(error.strerror)) from None
        except ValidationError as error:
            raise _no_answers(path, first_problem(error)) from None
        except ValueError as error:
            raise _no_answers(path, str(error)) from None
        return {item.name: found[item.name] for item in asked}

    def _rated_at_seat(self, run: str) -> Answers | None:
        """Return the NASA-TLX ratings that were given at the seat, None if there are none."""
        try:
            summary = RunFolder(self.folder / run).summary() or {}
            person = summary["people"][self._number]  # A finished run has the seats of the plan.
            return NasaTlx.model_validate(person["workload"]["nasa_tlx"]).model_dump()
        except (RunFolderError, ValueError, LookupError, TypeError):
            return None

    def answer(self, asked: Asked, answers: Answers) -> None:
        """Keep what was answered.

        Raises
        ------
        StationError
            The answers are not those that the questionnaire takes, or cannot be written.
        """
        path = self._path(asked.questionnaire, asked.run)
        try:
            asked.questionnaire.check(answers)
            make_folder(path.parent)
            replace_file(path, json.dumps(answers, indent=2).encode())
        except ValueError as error:
            raise StationError(str(error)) from None
        except OSError as error:
            raise StationError(f"{path}: cannot be written: {error.strerror}") from None

    def next_trial(self) -> Trial | None:
        """Return the first trial that is not done, None if there is none."""
        return next((trial for trial in self.trials if not self.is_done(trial)), None)

    def asked(self) -> Asked | None:
        """Return what is to be answered now, before anything else is done; None if nothing is."""
        trial = self.next_trial()
        due = [Asked(self.plan.before())]
        if trial is None:
            due.append(Asked(self.plan.end()))
        elif (run := self.finished_run(trial)) is not None:
            due += [Asked(questionnaire, run) for questionnaire in self.plan.after_trial()]
        return next((asked for asked in due if not self._is_answered(*asked)), None)

    def is_done(self, trial: Trial) -> bool:
        """Return true if a trial has been run, and its questions answered."""
        name = self.finished_run(trial)
        return name is not None and all(
            self._is_answered(questionnaire, name) for questionnaire in self.plan.after_trial()
        )

    def _is_answered(self, questionnaire: Questionnaire, run: str) -> bool:
        return not questionnaire.items or self.answers(questionnaire, run) is not None

    def _path(self, questionnaire: Questionnaire, run: str) -> Path:
        return self._answers / ".".join(filter(None, (run, questionnaire.name, "json")))


def _no_answers(path: Path, problem: str) -> RunFolderError:
    return RunFolderError(
        f"{path}: {problem}; expected answers to the questions of the plan, as the page writes "
        "them; move the file away to ask again"
    )


def _seat_times_s(run: RunFolder) -> _SeatTimes:
    """Return how long each seat of a run was taken, in s, in the order of the team.

    It is None where an earlier version did not tell, and there are no seats where the summary
    does not tell of any.
    """
    try:
        people = (run.summary() or {})["people"]
        return {str(person["seat"]): person.get("seat_time_s") for person in people}
    except (RunFolderError, LookupError, TypeError, AttributeError):
        return {}


def _refuse_another_order(team: Sequence[str], folder: Path) -> None:
    """Complain if there is a folder of the same team in another order.

    Raises
    ------
    RunFolderError
        There is one: the trials in it would count as not done.
    """
    found = folder.parent.glob(f"*{TOGETHER}*") if len(team) > 1 else ()
    for other in found:
        if other != folder and sorted(other.name.split(TOGETHER)) == sorted(team):
            raise RunFolderError(
                f"{other}: of {', '.join(team)} in another order; expected the order of the "
                "folder in the plan; put it back there"
            )


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
            given["wait_for_seats"] = True
            given["pause"] = plan.pause
            given["nasa_tlx"] = plan.nasa_tlx
            given["run_name"] = f"Trial-{state['trial']}"  # It tells a participant nothing.
            name = self._progress(participant).new_run(trial)
            self._started.start(loading.find(trial.scenario), options_of(given), name)

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
        """Return the progress of a participant; empty: of who alone is led.

        Raises
        ------
        StationError
            Nobody of that name is led.
        """
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
        run = self._last_run()
        if run is not None and run.name in progress.attempts(trials[done]):
            if (doing := self._started.state(run)) != "ended":
                progress.require_same_seats(trials[done], run.name, run.seats)
                own = readable(progress.seat(trials[done]))
                url = self._started.url(run) if doing == "running" else ""
                return shown | {"step": doing, "url": url, "seat": own}
            shown["said"] = "The last run of this trial did not finish."
        return shown | {"step": "ready", "rest_s": self._rest_s(done)}

    def _last_run(self) -> StartedRun | None:
        return next(iter(self._started.runs()), None)

    def _rest_s(self, position: int) -> float:
        """Return how much of a break is left before a trial, in s."""
        plan = self._plan
        if self._rested_since_s is None or not plan.break_after or position % plan.break_after:
            return 0.0
        return max(plan.break_minutes * 60.0 - (time.monotonic() - self._rested_since_s), 0.0)
