"""The run folders of the trials of a participant, or of a team, in the folder of the participants.

What is finished is not run again. What was stopped is begun again in another folder, and stays.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from airhilt.errors import RunFolderError, StationError, first_line
from airhilt.record import RunFolder
from airhilt.scenario import loading
from airhilt.scenario.seats import seats_of
from airhilt.station.file_cache import FileCache
from airhilt.station.plan import Plan, Trial
from airhilt.text import readable
from airhilt.world.loading import load

MOST_ATTEMPTS = 100
"""Largest number of times that a trial is begun."""
TOGETHER = "+"
"""Text between the participants of a team in the name of their folder; no identifier has it."""
_SeatTimes = dict[str, float | None]
"""Times by seat, in s."""


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

    Raises
    ------
    RunFolderError
        The folder of the team is there with its participants in another order.
    """

    def __init__(
        self, plan: Plan, folder: Path, team: Sequence[str], trials: Sequence[Trial]
    ) -> None:
        self.folder = folder / TOGETHER.join(team)
        self._plan = plan
        self._trials = trials
        self._seats: dict[str, tuple[str, ...]] = {}
        self._phases = FileCache[str]()
        self._times_s = FileCache[_SeatTimes]()
        _refuse_another_order(team, self.folder)

    def seats(self, trial: Trial) -> tuple[str, ...]:
        """Return the units and callsigns of the seats of a trial, in the order of the team."""
        found = self._seats.get(trial.scenario)
        if found is None:
            found = seats_of(self._plan.all_seats, load(loading.find(trial.scenario)))
            self._seats[trial.scenario] = found
        return found

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
        seats = self.seats(trial)
        if tuple(had) != seats:
            were = "its seats were" if len(seats) > 1 else "its seat was"
            raise RunFolderError(
                f"{self.folder / name}: {were} {readable(', '.join(had))}; expected "
                f"{', '.join(seats)}, as the plan has them now; put them back in the plan, or run "
                "the changed plan in another folder"
            )

    def attempts(self, trial: Trial) -> Iterator[str]:
        """Yield the names of the run folders of a trial that may be there, in their order."""
        position = self._trials.index(trial) + 1
        for number in range(1, MOST_ATTEMPTS):
            yield f"{position:02d}-{trial.name}" + (f"-{number}" if number > 1 else "")

    def finished_run(self, trial: Trial) -> str | None:
        """Return the name of the run folder of a trial that its participant has done.

        Its run has ended by itself, and somebody had the seat, or each of its seats.

        Raises
        ------
        RunFolderError
            Its seats were others than those of the plan, or its summary does not tell them.
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
        """Return how long the seats of a run were taken, None if it has not ended by itself.

        Raises
        ------
        RunFolderError
            It has, and its summary does not tell.
        """
        try:
            has_ended = self._phases.get(lambda: run.info().phase, run.info_path) == "finished"
        except RunFolderError:
            return None
        if not has_ended:
            return None
        return self._times_s.get(lambda: _seat_times_s(run), run.summary_path)

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


def _seat_times_s(run: RunFolder) -> _SeatTimes:
    """Return how long each seat of a run was taken, in s, in the order of the team.

    It is None where an earlier version did not tell, and there are no seats where there is no
    summary, or none of people.

    Raises
    ------
    RunFolderError
        It cannot be read, or is none.
    """
    people = (run.summary() or {}).get("people", ())
    try:
        return {str(person["seat"]): person.get("seat_time_s") for person in people}
    except (LookupError, TypeError, AttributeError) as error:
        raise RunFolderError(
            f"{run.summary_path}: its people cannot be read ({first_line(error)}); expected them "
            "as a run writes them; move the folder away to run the trial again"
        ) from None


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
