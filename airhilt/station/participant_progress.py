"""The progress of a participant in an experiment: what is done, and what is to be done next.

Each participant has a folder, with a run folder and the answers of each trial. Participants who
have seats in the same trials share the run folders, in the folder of their team, and each has a
folder in it for the own answers. What is finished is not run again. What was stopped is begun again
in another folder, and stays.
"""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import TypeAdapter, ValidationError

from airhilt.errors import RunFolderError, StationError, first_line, first_problem
from airhilt.host.files import make_folder, read_inside, replace_file
from airhilt.host.text import readable
from airhilt.record import RunFolder
from airhilt.scenario import loading
from airhilt.scenario.seats import seats_of
from airhilt.station.plan import Plan, Trial
from airhilt.station.questionnaires import NASA_TLX, Answers, Questionnaire
from airhilt.world.loading import load

LARGEST_ANSWERS_BYTES = 100_000
"""Size of the largest file with answers that is read."""
MOST_ATTEMPTS = 1000
"""Largest number of times that a trial is begun."""
TOGETHER = "+"
"""Text between the participants of a team in the name of their folder; no identifier has it."""
KEPT_ANSWERS = TypeAdapter(Answers)


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
    trials
        Trials, in the order of the participant.
    folder
        Folder of the run folders of the participant, or of the team.
    """

    def __init__(self, plan: Plan, folder: Path, participant: str) -> None:
        team = plan.team_of(participant)
        self.plan = plan
        self.participant = participant
        self.trials = plan.order_of(participant)
        self.folder = folder / TOGETHER.join(team)
        self._number = team.index(participant)
        self._answers_folder = self.folder if len(team) == 1 else self.folder / participant
        self._finished: dict[str, str] = {}
        """Names of the run folders of trials that are done, by the names of the trials."""

    # --- runs -------------------------------------------------------------------------------

    def seat(self, trial: Trial) -> str:
        """Return the unit or callsign whose seat the participant has in a trial."""
        return _seats(trial.scenario, self.plan.all_seats)[self._number]

    def attempts(self, trial: Trial) -> list[str]:
        """Return the names of the run folders that a trial may have, in their order."""
        first = f"{self.trials.index(trial) + 1:02d}-{trial.name}"
        return [first, *(f"{first}-{number}" for number in range(2, MOST_ATTEMPTS))]

    def finished_run(self, trial: Trial) -> str | None:
        """Return the name of the run folder of a trial that has been run.

        Its run has ended by itself, and somebody had the seat, or each of its seats.

        Raises
        ------
        RunFolderError
            Its seats were others than those of the plan, or its files do not tell.
        """
        if trial.name not in self._finished:
            for name in self._begun(trial):
                if self._has_finished(trial, RunFolder(self.folder / name)):
                    self._finished[trial.name] = name
                    break
        return self._finished.get(trial.name)

    def new_run(self, trial: Trial) -> str:
        """Return the name of a run folder of a trial, behind all that are there."""
        attempts, begun = self.attempts(trial), self._begun(trial)
        return attempts[attempts.index(begun[-1]) + 1] if begun else attempts[0]

    def _begun(self, trial: Trial) -> list[str]:
        """Return the names of the run folders of a trial that are there, in their order."""
        there = {path.name for path in self.folder.iterdir()} if self.folder.is_dir() else set()
        return [name for name in self.attempts(trial) if name in there]

    def _has_finished(self, trial: Trial, run: RunFolder) -> bool:
        try:
            if run.info().phase != "finished":
                return False
        except RunFolderError:  # It was killed before it wrote its record.
            return False
        times_s = _seat_times_s(run)
        seats = _seats(trial.scenario, self.plan.all_seats)
        if times_s and tuple(times_s) != seats:  # Who had which is not known.
            were = "its seats were" if len(seats) > 1 else "its seat was"
            raise RunFolderError(
                f"{run.path}: {were} {readable(', '.join(times_s))}; expected {', '.join(seats)}, "
                "as the plan has them now; put them back in the plan, or run the changed plan in "
                "another folder"
            )
        return 0.0 not in times_s.values()

    # --- trials and questions ---------------------------------------------------------------

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
        return next((asked for asked in due if not self._is_answered(asked)), None)

    def is_done(self, trial: Trial) -> bool:
        """Return true if a trial has been run, and its questions answered."""
        name = self.finished_run(trial)
        return name is not None and all(
            self._is_answered(Asked(questionnaire, name))
            for questionnaire in self.plan.after_trial()
        )

    def _is_answered(self, asked: Asked) -> bool:
        return not asked.questionnaire.items or self.answers(asked) is not None

    def answers(self, asked: Asked) -> Answers | None:
        """Return what was answered, None if nothing was yet.

        Raises
        ------
        RunFolderError
            The file of the answers cannot be read, or has an answer that the item does not take. An
            item without an answer is none: it may have come into the plan later.
        """
        path, questionnaire = self._path(asked), asked.questionnaire
        try:
            found = KEPT_ANSWERS.validate_json(
                read_inside(self.folder, path, LARGEST_ANSWERS_BYTES)
            )
            items = [item for item in questionnaire.items if item.name in found]
            for item in items:
                item.check(found[item.name])
        except FileNotFoundError:
            return self._rated_at_seat(asked.run) if questionnaire == NASA_TLX else None
        except (OSError, ValueError) as error:
            problem = first_problem(error) if isinstance(error, ValidationError) else str(error)
            raise RunFolderError(
                f"{path}: {problem}; expected answers to the questions of the plan, as the page "
                "writes them; move the file away to ask again"
            ) from None
        return {item.name: found[item.name] for item in items}

    def answer(self, asked: Asked, answers: Answers) -> None:
        """Keep what was answered.

        Raises
        ------
        StationError
            The answers are not those that the questionnaire takes, or cannot be written.
        """
        path = self._path(asked)
        try:
            asked.questionnaire.check(answers)
            make_folder(path.parent)
            replace_file(path, json.dumps(answers, indent=2).encode())
        except ValueError as error:
            raise StationError(str(error)) from None
        except OSError as error:
            raise StationError(f"{path}: cannot be written: {error.strerror}") from None

    def _path(self, asked: Asked) -> Path:
        parts = (asked.run, asked.questionnaire.name, "json")
        return self._answers_folder / ".".join(filter(None, parts))

    def _rated_at_seat(self, run: str) -> Answers | None:
        """Return the NASA-TLX ratings that were given at the seat, None if there are none."""
        summary: dict[str, Any] = RunFolder(self.folder / run).summary() or {}
        # A finished run has the seats of the plan, in its order.
        people = [person["workload"] for person in summary.get("people", ())]
        asked = people[self._number] if people else None
        return asked["nasa_tlx"] if asked else None  # Nothing may have been asked there.


@lru_cache(maxsize=100)
def _seats(scenario: str, names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the units and callsigns of seats in a scenario, in their order."""
    return seats_of(names, load(loading.find(scenario)))


def _seat_times_s(run: RunFolder) -> dict[str, float]:
    """Return for how long each seat of a run was taken, in s, in the order of the team."""
    problem = "missing"
    try:
        if (summary := run.summary()) is not None:
            return {str(one["seat"]): one["seat_time_s"] for one in summary.get("people", ())}
    except (RunFolderError, LookupError, TypeError) as error:
        problem = first_line(error)
    raise RunFolderError(
        f"{run.summary_path}: {problem}; expected the numbers of the run; move the folder away to "
        "run the trial again"
    )
