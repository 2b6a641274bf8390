"""The bus of a run, without the run."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import closing, contextmanager

from airhilt.bus.access import WITHOUT_KEYS, Role
from airhilt.bus.session import Bus
from airhilt.messages import Clock


@contextmanager
def bus_of_a_run(*more: Role) -> Iterator[Bus]:
    """Yield a bus on which a run is found; every program has further roles on it."""
    anyone: Collection[Role] = (*WITHOUT_KEYS, *more)
    with closing(Bus("run", anyone=anyone)) as bus:
        clock = Clock(run="run", phase="running", pace="1x")
        bus.keep("clock", clock.model_dump_json().encode())
        yield bus
