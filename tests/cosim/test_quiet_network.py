"""A run talks to nobody but itself."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from airhilt import load
from shortened import shortened

LOOPBACK_UP = """
import fcntl, os, socket, struct, sys
with socket.socket() as any_socket:
    fcntl.ioctl(any_socket, 0x8914, struct.pack("16sh", b"lo", 1))  # SIOCSIFFLAGS, IFF_UP
os.execvp(sys.argv[1], sys.argv[1:])
"""
OTHER_ENGINES = (
    "--no-cameras", "--snr", "10", "--topology", "asr_first", "--enhancer", "spectral",
    "--assistant", "paper", "--equipment", "conflict_alert",
)  # fmt: skip
"""Engines that ship, and that a run does not have unless it is told so."""
NEEDS_FLITE = pytest.mark.skipif(shutil.which("flite") is None, reason="needs flite")
SPEAKS_TO = re.compile(
    r'(?:connect|sendto|sendmsg)\(.*(?:inet_addr\(|inet_pton\(AF_INET6, )"([^"]+)"'
)

LOOPBACK = re.compile(r"127\.\d+\.\d+\.\d+|::1|::ffff:127\.\d+\.\d+\.\d+")


def _namespace_problem() -> str:
    """Return why a program cannot be traced in a network of its own here, empty if it can."""
    for name in ("unshare", "strace"):
        if shutil.which(name) is None:
            return f"needs {name}"
    tried = ["unshare", "--map-root-user", "--net", sys.executable, "-c", LOOPBACK_UP]
    done = subprocess.run([*tried, "strace", "-o", "/dev/null", "true"], capture_output=True)
    return "" if done.returncode == 0 else "network namespaces or traces are not allowed here"


def talked_to(scenario: dict[str, Any], folder: Path, home: Path, *flags: str) -> set[str]:
    """Return the addresses to which a run sends.

    It runs in a network that has its loopback interface alone, with a home of its own.
    """
    file, trace = folder / "scenario.json", folder / "trace.txt"
    file.write_text(json.dumps(scenario))
    command = [
        "unshare", "--map-root-user", "--net", sys.executable, "-c", LOOPBACK_UP,
        "strace", "-f", "-e", "trace=connect,sendto,sendmsg", "-o", str(trace),
        sys.executable, "-m", "airhilt", "cosim", "--scenario", str(file),
        "--latency", "fixed", "--no-report", "--out", str(folder / "run"), *flags,
    ]  # fmt: skip
    variables = {"HOME": str(home), "XDG_CACHE_HOME": str(home / ".cache")}
    done = subprocess.run(
        command, env={**os.environ, **variables}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    lines = trace.read_text(errors="replace").splitlines()
    return {found[1] for line in lines if (found := SPEAKS_TO.search(line))}


def kept_by_others(home: Path) -> list[str]:
    """Return the files below a home that are not of AIRHILT's own cache."""
    return [
        str(path.relative_to(home))
        for path in home.rglob("*")
        if path.is_file() and "airhilt" not in path.relative_to(home).parts
    ]


@pytest.mark.skipif(sys.platform != "linux", reason="needs network namespaces")
@pytest.mark.parametrize(
    "flags",
    [
        ("--no-cameras", "--snr", "10"),
        pytest.param((), marks=pytest.mark.slow),
        pytest.param(OTHER_ENGINES, marks=pytest.mark.slow),
        pytest.param(("--no-cameras", "--tts", "flite"), marks=[pytest.mark.slow, NEEDS_FLITE]),
    ],
)
def test_a_run_connects_to_nobody_and_leaves_nothing_for_others_to_send(
    tmp_path: Path, flags: tuple[str, ...]
) -> None:
    if problem := _namespace_problem():
        pytest.skip(problem)
    scenario = shortened(load("s01a_bad_readback").model_dump(mode="json"), 2.0)
    home = tmp_path / "home"
    home.mkdir()
    addresses = talked_to(scenario, tmp_path, home, *flags)
    assert {each for each in addresses if not LOOPBACK.fullmatch(each)} == set()
    assert kept_by_others(home) == []
