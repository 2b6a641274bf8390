"""The progress of a participant in an experiment: what is done, and what is to be done next.

Each participant has a folder, with a run folder and the answers of each trial. Participants who
have seats in the same trials share the run folders, in the folder of their team, and each has a
folder in it for the own answers.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import TypeAdapter, ValidationError

from airhilt.errors import RunFolderError, StationError, first_problem
from airhilt.host.files import make_folder, read_inside, replace_file
from airhilt.record import RunFolder
from airhilt.station.plan import Plan, Trial
from airhilt.station.questionnaires import NASA_TLX, Answers, Questionnaire
from airhilt.station.trial_order import order_of
from airhilt.station.trial_runs import TrialRuns

LARGEST_ANSWERS_BYTES = 100_000
"""Size of the largest file with answers that is read."""
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
    runs
        Runs of the participant, or of the team.
    trials
        Trials, in the order of the participant.
    """

    def __init__(self, plan: Plan, folder: Path, participant: str) -> None:
        team = plan.team_of(participant)
        self.plan = plan
        self.participant = participant
        self.trials = order_of(plan, participant)
        self.runs = TrialRuns(plan, folder, team, self.trials)
        self._number = team.index(participant)
        together = self.runs.folder
        self._folder = together if len(team) == 1 else together / participant
        """Folder of the answers."""
        self._answered: dict[Path, Answers] = {}
        """Answers that were read, by the path of their file."""

    def seat(self, trial: Trial) -> str:
        """Return the unit or callsign whose seat the participant has in a trial."""
        return self.runs.seats(trial)[self._number]

    def next_trial(self) -> Trial | None:
        """Return the first trial that is not done, None if there is none."""
        return next((trial for trial in self.trials if not self.is_done(trial)), None)

    def asked(self) -> Asked | None:
        """Return what is to be answered now, before anything else is done; None if nothing is."""
        trial = self.next_trial()
        due = [Asked(self.plan.before())]
        if trial is None:
            due.append(Asked(self.plan.end()))
        elif (run := self.runs.finished_run(trial)) is not None:
            due += [Asked(questionnaire, run) for questionnaire in self.plan.after_trial()]
        return next((asked for asked in due if not self._is_answered(asked)), None)

    def is_done(self, trial: Trial) -> bool:
        """Return true if a trial has been run, and its questions answered."""
        name = self.runs.finished_run(trial)
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
        path = self._path(asked)
        if path not in self._answered and (found := self._read(asked)) is not None:
            self._answered[path] = found
        return self._answered.get(path)

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
        return self._folder / ".".join(filter(None, parts))

    def _read(self, asked: Asked) -> Answers | None:
        path, questionnaire = self._path(asked), asked.questionnaire
        try:
            found = KEPT_ANSWERS.validate_json(
                read_inside(self.runs.folder, path, LARGEST_ANSWERS_BYTES)
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

    def _rated_at_seat(self, run: str) -> Answers | None:
        """Return the NASA-TLX ratings that were given at the seat, None if there are none.

        Raises
        ------
        RunFolderError
            The summary of the run cannot be read.
        """
        summary: dict[str, Any] = RunFolder(self.runs.folder / run).summary() or {}
        # A finished run has the seats of the plan, in its order.
        people = [person["workload"] for person in summary.get("people", ())]
        return people[self._number]["nasa_tlx"] if people else None
