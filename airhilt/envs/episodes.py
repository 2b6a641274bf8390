"""The episodes of an environment, one after the other, and their run folders."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from airhilt.cosim.observer import Observer
from airhilt.envs.episode import Episode, Plan, Stepped
from airhilt.errors import AirhiltError


class Episodes:
    """Begins each episode when it is asked for, and ends the one before.

    Parameters
    ----------
    out
        Folder in which the run folder of each episode stays, as ``episode-0`` and so on. None: it
        is deleted.
    """

    def __init__(self, plan: Plan, out: str | Path | None, observer: Observer | None) -> None:
        self.plan = plan
        self._kept = None if out is None else Path(out)
        self._observer = observer or Observer()
        self._deleted: TemporaryDirectory[str] | None = None
        self._count = 0
        self._episode: Episode | None = None

    def reset(self, seed: int) -> Stepped:
        """Begin a run with a seed."""
        self.close()
        if self._kept is None:
            self._deleted = TemporaryDirectory(prefix="airhilt-")
            folder = Path(self._deleted.name) / "run"
        else:
            folder = self._kept / f"episode-{self._count}"
        self._count += 1
        self._episode = Episode(self.plan, seed, folder, self._observer)
        return self._episode.begin()

    @property
    def running(self) -> Episode:
        """The episode that goes on.

        Raises
        ------
        AirhiltError
            There is none.
        """
        if self._episode is None or self._episode.is_over:
            raise AirhiltError("no episode goes on; expected reset() before step()")
        return self._episode

    def close(self) -> None:
        """End the episode, and delete its folder if it is not to stay."""
        if self._episode is not None:
            self._episode.close()
            self._episode = None
        if self._deleted is not None:
            self._deleted.cleanup()
            self._deleted = None
