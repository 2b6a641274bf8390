"""Routers of a lab's own, between runs and their programs."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import MappingProxyType
from typing import Any

ROUTES = """
import sys, zenoh
session = zenoh.open(zenoh.Config.from_json5(sys.argv[1]))
print(flush=True)
sys.stdin.read()
session.close()
"""
"""A router as ``zenohd`` is one, configured by its argument, until it is told to end."""


@contextmanager
def router(
    listen: str,
    connect: Sequence[str],
    transport: Mapping[str, Any] = MappingProxyType({}),
) -> Iterator[subprocess.Popen[bytes]]:
    """A router that listens at one endpoint and goes on connecting to others until it can."""
    configuration = {
        "mode": "router",
        "listen": {"endpoints": [listen]},
        "connect": {"endpoints": list(connect), "timeout_ms": -1, "exit_on_failure": False},
        "scouting": {"multicast": {"enabled": False}},
        "transport": dict(transport),
    }
    command = [sys.executable, "-c", ROUTES, json.dumps(configuration)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as started:
        try:
            assert started.stdout is not None
            assert started.stdout.readline() == b"\n"
            yield started
        finally:
            started.kill()
