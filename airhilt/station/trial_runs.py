"""The run folders of the trials of a participant, or of a team, in the folder of the participants.

What is finished is not run again. What was stopped is begun again in another folder, and stays.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
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
_TO_RUN_AGAIN = "move the folder away to run the trial again"
TOGETHER = "+"
"""Text between the participants of a team in the name of their folder; no identifier has it."""


_SeatTimes = dict[str, float | None]
"""Time in s for which each seat was taken, in the order of the team; None: it is not known."""


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
        self._phases = FileCache[str | None]()
        self._times = FileCache[_SeatTimes | None]()
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
            Its seats were others than those of the plan, or its files do not tell.
        """
        for run in self._begun(trial):
            if self._phases.get(partial(_phase, run), run.info_path) != "finished":
                continue
            seats = self._times_of(run)
            if seats is None:
                raise RunFolderError(f"{run.summary_path}: missing; {_TO_RUN_AGAIN}")
            if seats:
                self.require_same_seats(trial, run.path.name, list(seats))
            if all(taken_s != 0.0 for taken_s in seats.values()):
                return run.path.name
        return None

    def _begun(self, trial: Trial) -> list[RunFolder]:
        """Return the run folders of a trial that are there, in their order."""
        there = {path.name for path in self.folder.iterdir()} if self.folder.is_dir() else set()
        return [RunFolder(self.folder / name) for name in self.attempts(trial) if name in there]

    def _times_of(self, run: RunFolder) -> _SeatTimes | None:
        return self._times.get(partial(_seat_times, run), run.summary_path)

    def new_run(self, trial: Trial) -> str:
        """Return the name of a run folder of a trial, behind all that are there.

        Raises
        ------
        StationError
            The trial was begun too often.
        """
        begun = {run.path.name for run in self._begun(trial)}
        free: str | None = None
        for name in self.attempts(trial):
            free = None if name in begun else free or name
        if free is not None:
            return free
        raise StationError(f"trial {trial.name}: begun {MOST_ATTEMPTS} times; look at its folders")


def _phase(run: RunFolder) -> str | None:
    """Return the phase that a run has written; None if it has not, or what it wrote is damaged.

    Raises
    ------
    RunFolderError
        The file cannot be read now.
    """
    try:
        data = run.read(run.info_path)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise RunFolderError(f"{run.info_path}: cannot be read: {error.strerror}") from None
    try:
        return run.info_in(data).phase
    except RunFolderError:
        return None


def _seat_times(run: RunFolder) -> _SeatTimes | None:
    """Return the seats of a run in the order of the team, none if nobody had any.

    It is None if the run has written no summary.

    Raises
    ------
    RunFolderError
        The summary cannot be read, or is none.
    """
    try:
        summary = run.summary()
        if summary is None:
            return None
        return {str(one["seat"]): one.get("seat_time_s") for one in summary.get("people", ())}
    except RunFolderError as error:
        raise RunFolderError(f"{error}; {_TO_RUN_AGAIN}") from None
    except (LookupError, TypeError, AttributeError) as error:
        raise RunFolderError(
            f"{run.summary_path}: its people cannot be read ({first_line(error)}); expected them "
            f"as a run writes them; {_TO_RUN_AGAIN}"
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
