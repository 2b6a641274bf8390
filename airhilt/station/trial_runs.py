"""The run folders of the trials of a participant, or of a team, in the folder of the participants.

What is finished is not run again. What was stopped is begun again in another folder, and stays.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from airhilt.errors import RunFolderError, first_line
from airhilt.host.text import readable
from airhilt.record import RunFolder
from airhilt.scenario import loading
from airhilt.scenario.seats import seats_of
from airhilt.station.plan import Plan, Trial
from airhilt.world.loading import load

MOST_ATTEMPTS = 1000
"""Largest number of times that a trial is begun."""
TOGETHER = "+"
"""Text between the participants of a team in the name of their folder; no identifier has it."""


class TrialRuns:
    """Finds the runs of the trials of a team, or of a participant who is alone in them.

    Parameters
    ----------
    folder
        Folder of the experiment.
    team
        Participants, in the order of the seats.
    trials
        Trials, in the order of these participants.

    Attributes
    ----------
    folder
        Folder of the run folders.
    """

    def __init__(
        self, plan: Plan, folder: Path, team: Sequence[str], trials: Sequence[Trial]
    ) -> None:
        self.folder = folder / TOGETHER.join(team)
        self._plan = plan
        self._trials = trials
        self._seats: dict[str, tuple[str, ...]] = {}
        self._finished: dict[str, str] = {}
        """Names of the run folders of trials that are done, by the names of the trials."""

    def seats(self, trial: Trial) -> tuple[str, ...]:
        """Return the units and callsigns of the seats of a trial, in the order of the team."""
        if trial.scenario not in self._seats:
            scenario = load(loading.find(trial.scenario))
            self._seats[trial.scenario] = seats_of(self._plan.all_seats, scenario)
        return self._seats[trial.scenario]

    def attempts(self, trial: Trial) -> list[str]:
        """Return the names of the run folders that a trial may have, in their order."""
        first = f"{self._trials.index(trial) + 1:02d}-{trial.name}"
        return [first, *(f"{first}-{number}" for number in range(2, MOST_ATTEMPTS))]

    def finished_run(self, trial: Trial) -> str | None:
        """Return the name of the run folder of a trial that its participant has done.

        Its run has ended by itself, and somebody had the seat, or each of its seats.

        Raises
        ------
        RunFolderError
            Its seats were others than those of the plan, or its files do not tell.
        """
        if trial.name not in self._finished:
            for name in self._begun(trial):
                if self._is_done(trial, RunFolder(self.folder / name)):
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

    def _is_done(self, trial: Trial, run: RunFolder) -> bool:
        """Return true if a run has ended by itself, and somebody had each of its seats.

        Raises
        ------
        RunFolderError
            Its seats were others than those of the plan, or its summary does not tell.
        """
        try:
            if run.info().phase != "finished":
                return False
        except RunFolderError:  # It was killed before it wrote its record.
            return False
        times_s = _seat_times_s(run)
        if times_s:
            self._require_seats_of_plan(trial, run.path, tuple(times_s))
        return 0.0 not in times_s.values()

    def _require_seats_of_plan(self, trial: Trial, run: Path, had: tuple[str, ...]) -> None:
        """Complain about a run with other seats than in the plan: who had which is not known.

        Raises
        ------
        RunFolderError
            They were others, or in another order.
        """
        seats = self.seats(trial)
        if had != seats:
            were = "its seats were" if len(seats) > 1 else "its seat was"
            raise RunFolderError(
                f"{run}: {were} {readable(', '.join(had))}; expected {', '.join(seats)}, as the "
                "plan has them now; put them back in the plan, or run the changed plan in another "
                "folder"
            )


def _seat_times_s(run: RunFolder) -> dict[str, float]:
    """Return for how long each seat of a run was taken, in s, in the order of the team.

    Raises
    ------
    RunFolderError
        The run has no summary, or it cannot be read.
    """
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
