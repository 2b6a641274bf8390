#!/usr/bin/env python3
"""Run a command beside a SLURM of its own: munged, slurmctld and slurmd on this machine.

    tools/slurm_on_one_machine.py python slurm.py airhilt sweep --scheduler scheduler.json ...

``slurm.py`` is the recipe of docs/clusters.md.

It needs Debian's packages slurm-wlm and munge, and root. Configuration, keys and logs are in a
temporary folder, and everything ends with the command. The one partition is called ``main``.
"""

from __future__ import annotations

import os
import secrets
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "sinfo")
PATIENCE_S = 60.0
"""Time that the daemons have to start, in s."""
KEY_BYTES = 1024
CONFIGURATION = """\
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
ReturnToService=2
KillWait=5
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory={memory_mb} State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def missing() -> list[str]:
    """Return the programs of SLURM and munge that are not on PATH."""
    return [name for name in PROGRAMS if shutil.which(name) is None]


@contextmanager
def slurm() -> Iterator[Mapping[str, str]]:
    """Run the daemons; yields the environment for commands such as ``sbatch``.

    Raises
    ------
    RuntimeError
        The node does not come up.
    """
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="slurm-")))
        _write_files(folder)
        environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
        munge = folder / "munge"
        stack.enter_context(
            _daemon(
                *("munged", "--foreground", f"--socket={munge / 'socket'}"),
                *(f"--key-file={munge / 'key'}", f"--pid-file={munge / 'pid'}"),
                *(f"--log-file={munge / 'log'}", f"--seed-file={munge / 'seed'}"),
                log=munge / "output",
                environment=environment,
            )
        )
        for name in ("slurmctld", "slurmd"):
            log = folder / f"{name}.output"
            stack.enter_context(_daemon(name, "-D", log=log, environment=environment))
        _wait_for_the_node(folder, environment)
        yield environment


def _write_files(folder: Path) -> None:
    folder.chmod(0o755)
    for name in ("munge", "state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge" / "key"
    key.write_bytes(secrets.token_bytes(KEY_BYTES))
    key.chmod(0o600)
    (folder / "slurm.conf").write_text(
        CONFIGURATION.format(
            host=socket.gethostname().partition(".")[0],
            ports=_free_ports(2),
            folder=folder,
            cores=os.cpu_count(),
            memory_mb=os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20,
        )
    )


def _free_ports(count: int) -> list[int]:
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.create_server(("", 0))) for _ in range(count)]
        return [each.getsockname()[1] for each in sockets]


@contextmanager
def _daemon(*command: str, log: Path, environment: Mapping[str, str]) -> Iterator[None]:
    with log.open("wb") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output, env=environment)
        try:
            yield
        finally:
            process.terminate()
            try:
                process.wait(10.0)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _wait_for_the_node(folder: Path, environment: Mapping[str, str]) -> None:
    until = time.monotonic() + PATIENCE_S
    while time.monotonic() < until:
        asked = subprocess.run(
            ["sinfo", "--noheader", "--format=%T"],
            capture_output=True,
            text=True,
            env=environment,
            check=False,
        )
        if asked.stdout.strip() == "idle":
            return
        time.sleep(0.2)
    logs = "\n".join(log.read_text() for log in folder.rglob("*.output"))
    raise RuntimeError(f"SLURM's node is not up after {PATIENCE_S:.0f} s:\n{asked.stderr}{logs}")


def main() -> int:
    """Run the command that is given."""
    if absent := missing():
        print(
            f"without {', '.join(absent)}; `apt install slurm-wlm munge` has them",
            file=sys.stderr,
        )
        return 2
    with slurm() as environment:
        return subprocess.run(sys.argv[1:], env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
