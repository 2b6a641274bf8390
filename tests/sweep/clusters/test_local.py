"""Workers on this machine."""

from __future__ import annotations

import pytest
from distributed import Client
from distributed.security import Security

from airhilt.sweep.scheduler import LOCAL, connect


def test_nobody_else_on_the_machine_can_reach_them() -> None:
    """Whoever reaches a scheduler of Dask can run programs as its user."""
    with connect(LOCAL, 1, None) as client:
        assert client.submit(abs, -7).result(timeout=60) == 7
        (worker,) = client.scheduler_info()["workers"]
        for address in (client.scheduler.address, worker):
            assert address.startswith("tls://127.0.0.1:")
        with pytest.raises(OSError, match="certificate does not match"):
            Client(client.scheduler.address, security=Security.temporary(), timeout=1.0)
