"""The bus of a run without the run, and a router of other programs."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import closing, contextmanager

import zenoh

from airhilt.bus.access import WITHOUT_KEYS, Role
from airhilt.bus.session import Bus, close_session, configuration, free_endpoint
from airhilt.messages import Clock


@contextmanager
def bus_of_a_run(*more: Role) -> Iterator[Bus]:
    """Yield a bus on which a run is found; every program has further roles on it."""
    anyone: Collection[Role] = (*WITHOUT_KEYS, *more)
    with closing(Bus("run", anyone=anyone)) as bus:
        clock = Clock(run="run", phase="running", pace="1x")
        bus.keep("clock", clock.model_dump_json().encode())
        yield bus


@contextmanager
def router_of_others() -> Iterator[str]:
    """Yield the endpoint of a router that no run has, such as rmw_zenohd of ROS 2."""
    endpoint = free_endpoint()
    session = zenoh.open(configuration("router", "listen", endpoint))
    try:
        yield endpoint
    finally:
        close_session(session)
