"""The progress of a participant in an experiment: what is done, and what is to be done next.

Each participant has a folder, with a run folder and the answers of each trial. Participants who
have seats in the same trials share the run folders, in the folder of their team, and each has a
folder in it for the own answers.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from airhilt.station.answer_files import AnswerFiles
from airhilt.station.plan import Plan, Trial
from airhilt.station.questionnaires import Answers, Questionnaire
from airhilt.station.trial_order import order_of
from airhilt.station.trial_runs import TrialRuns


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

    Raises
    ------
    RunFolderError
        The folder of the team is there with its participants in another order.
    """

    def __init__(self, plan: Plan, folder: Path, participant: str) -> None:
        team = plan.team_of(participant)
        self.plan = plan
        self.participant = participant
        self.trials = order_of(plan, participant)
        self.runs = TrialRuns(plan, folder, team, self.trials)
        self._number = team.index(participant)
        together = self.runs.folder
        own = together if len(team) == 1 else together / participant
        self._answers = AnswerFiles(together, own, self._number)

    def seat(self, trial: Trial) -> str:
        """Return the unit or callsign whose seat the participant has in a trial."""
        return self.runs.seats(trial)[self._number]

    def answers(self, asked: Asked) -> Answers | None:
        """Return what was answered, None if nothing was yet.

        Raises
        ------
        RunFolderError
            The answers cannot be read, or are not those that the questionnaire takes.
        """
        return self._answers.read(*asked)

    def answer(self, asked: Asked, answers: Answers) -> None:
        """Keep what was answered.

        Raises
        ------
        StationError
            The answers are not those that the questionnaire takes, or cannot be written.
        """
        self._answers.write(asked.questionnaire, answers, asked.run)

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
