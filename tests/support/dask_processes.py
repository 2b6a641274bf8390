"""A Dask cluster whose parts are processes, each on a machine of its own where there is one."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import psutil

PATIENCE_S = 180.0


def wait_until(holds: Callable[[], object]) -> None:
    """Wait until something holds, and fail if it never does."""
    until = time.monotonic() + PATIENCE_S
    while not holds():
        assert time.monotonic() < until, "it did not come"
        time.sleep(0.05)


class Machine:
    """A place for processes: a network namespace, or this machine if the name is empty."""

    def __init__(self, address: str, namespace: str = "") -> None:
        self.address = address
        self._prefix = ["ip", "netns", "exec", namespace] if namespace else []

    def start(
        self, *command: str | Path, log: Path, environment: Mapping[str, str] | None = None
    ) -> psutil.Popen:
        """Start a process in a group of its own, in the folder of the file that it prints to."""
        with log.open("ab") as output:
            return psutil.Popen(
                [*self._prefix, *map(str, command)],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=output,
                start_new_session=True,
                cwd=log.parent,
                env={**os.environ, **(environment or {})},
            )


def kill(process: psutil.Popen) -> None:
    """Kill a process and all that it has started, as a machine does that loses its power."""
    processes = [process, *process.children(recursive=True)] if process.is_running() else [process]
    for each in processes:
        with suppress(psutil.Error):
            each.send_signal(signal.SIGKILL)
    process.wait()


@contextmanager
def machines(count: int) -> Iterator[list[Machine]]:
    """Machines that see each other and nothing else: network namespaces on one bridge.

    Where they cannot be made, all of them are this machine.
    """
    with ExitStack() as stack:
        made = _namespaces(count, stack)
        yield made or [Machine("127.0.0.1") for _ in range(count)]


def _namespaces(count: int, stack: ExitStack) -> list[Machine]:
    if shutil.which("ip") is None or os.geteuid() != 0:
        return []
    mark = f"a{os.getpid()}"
    hub = f"{mark}h"
    try:
        _add(hub, stack)
        _ip("-n", hub, "link", "add", "bridge", "type", "bridge")
        _ip("-n", hub, "link", "set", "bridge", "up")
        found = []
        for index in range(count):
            name = f"{mark}n{index}"
            _add(name, stack)
            _ip(
                "-n", hub, "link", "add", f"p{index}", "type", "veth", "peer", "eth0", "netns", name
            )
            _ip("-n", hub, "link", "set", f"p{index}", "master", "bridge", "up")
            _ip("-n", name, "address", "add", f"10.77.0.{index + 1}/24", "dev", "eth0")
            _ip("-n", name, "link", "set", "eth0", "up")
            found.append(Machine(f"10.77.0.{index + 1}", name))
    except subprocess.CalledProcessError:
        return []
    return found


def _add(name: str, stack: ExitStack) -> None:
    _ip("netns", "add", name)
    stack.callback(_ip, "netns", "delete", name)
    _ip("-n", name, "link", "set", "lo", "up")


def _ip(*arguments: str) -> None:
    subprocess.run(["ip", *arguments], check=True, capture_output=True)


class Cluster:
    """A scheduler and workers, started and killed one by one.

    Parameters
    ----------
    folder
        Place for what they print.
    """

    def __init__(self, machines: Sequence[Machine], folder: Path, scheme: str = "tcp") -> None:
        self._machines = machines
        self._folder = folder
        self._scheme = scheme
        self.processes: dict[str, psutil.Popen] = {}
        with socket.create_server(("127.0.0.1", 0)) as free:
            self._port = free.getsockname()[1]
        self.address = f"{scheme}://{machines[0].address}:{self._port}"

    def start_scheduler(self) -> None:
        """Start the scheduler on the first machine."""
        host = self._machines[0].address
        options = ("--host", host, "--port", str(self._port), "--protocol", self._scheme)
        self._start("scheduler", 0, "scheduler", *options)

    def start_worker(
        self, index: int, environment: Mapping[str, str] | None = None, prefix: Sequence[str] = ()
    ) -> None:
        """Start a worker with one thread on the machine with that number.

        Parameters
        ----------
        prefix
            Program with arguments that starts the worker's command.
        """
        command = ("worker", self.address, "--nthreads", "1")
        self._start(f"worker{index}", index, *command, environment=environment, prefix=prefix)

    def _start(
        self,
        name: str,
        machine: int,
        *command: str,
        environment: Mapping[str, str] | None = None,
        prefix: Sequence[str] = (),
    ) -> None:
        self.processes[name] = self._machines[machine].start(
            *prefix,
            *(sys.executable, "-m", "dask", *command, "--no-dashboard"),
            log=self._folder / f"{name}.log",
            environment=environment,
        )

    def runners(self, name: str) -> list[int]:
        """Return the process numbers of the runners of a worker."""
        found = []
        for process in self.processes[name].children(recursive=True):
            with suppress(psutil.Error):
                if "airhilt.sweep.runner" in process.cmdline():
                    found.append(process.pid)
        return sorted(found)

    def kill(self, name: str) -> None:
        """Kill one of the processes, with what it has started."""
        kill(self.processes.pop(name))

    def __enter__(self) -> Cluster:
        return self

    def __exit__(self, *_: object) -> None:
        for process in self.processes.values():
            kill(process)
