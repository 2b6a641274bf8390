"""Mutants tried with tests, each in a process of its own that is forked from a prepared one."""

from __future__ import annotations

import contextlib
import importlib
import multiprocessing
import os
import shutil
import signal
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Literal, NamedTuple, Self

import pytest

from mutation.covering import PYTEST
from mutation.functions import changed_functions, replace
from mutation.mutants import Mutant

LIBRARIES = (
    "cryptography.x509", "hypothesis", "jsbsim", "mcap.reader", "networkx", "numpy", "onnxruntime",
    "PIL.Image", "psutil", "pydantic", "rich", "scipy.optimize", "scipy.signal", "scipy.stats",
    "shapely", "zenoh", "zstandard",
)  # fmt: skip
"""Modules that most tests need, imported once."""
PATIENCE = 5.0
"""Factor on the time that tests took without a mutant, after which they count as hanging."""
LEAST_LIMIT_S = 60.0
PREPARATION_LIMIT_S = 600.0
"""Time limit of tests without a mutant, in s."""

FORK = multiprocessing.get_context("fork")
Outcome = Literal["killed", "timeout", "survived", "uncovered"]


@dataclass(frozen=True)
class Verdict:
    """Outcome of a mutant, the first test that failed, and the time that it took."""

    outcome: Outcome
    test: str
    wall_s: float


class Request(NamedTuple):
    """Tests to be run, with the mutated text of a module if the functions in memory have it not."""

    tests: Sequence[str]
    limit_s: float
    module: str = ""
    before: str = ""
    after: str = ""


class Chosen:
    """Plugin of pytest that keeps some tests, in a given order, and knows the first failure."""

    def __init__(self, tests: Sequence[str]) -> None:
        self._places = {test: place for place, test in enumerate(tests)}
        self.failed = ""

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Leave out the others."""
        items[:] = [item for item in items if item.nodeid in self._places]
        items.sort(key=lambda item: self._places[item.nodeid])

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note the first test that fails."""
        if report.failed and not self.failed:
            self.failed = report.nodeid

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Note the first file of tests that cannot be imported."""
        if report.failed and not self.failed:
            self.failed = report.nodeid


class ForkServer:
    """A process in a tree that forks another one for each request.

    Parameters
    ----------
    files
        Files of tests that it imports beforehand, with all that they import.
    """

    def __init__(self, tree: Path, cache: Path, files: Sequence[str]) -> None:
        self._connection, theirs = FORK.Pipe()
        self._process = FORK.Process(target=_serve, args=(theirs, tree, cache, files))
        self._process.start()
        theirs.close()

    def run(self, request: Request) -> tuple[Outcome, str]:
        """Return what became of a request, and the first test that failed."""
        self._connection.send(request)
        outcome: tuple[Outcome, str] = self._connection.recv()
        return outcome

    def close(self) -> None:
        """End the process."""
        self._connection.send(None)
        self._process.join()


class Bench:
    """Tries mutants, one after the other, in a copy of the tree.

    A mutant of a function is tried in a process that has imported all tests before, with the code
    of that function replaced. Any other, and one of a function that the imports call, is tried in
    a process that imports everything anew.

    Parameters
    ----------
    tree
        The copy; one of its modules at a time is mutated.
    cache
        Cache folder that the tests without mutants have filled; each mutant has its own copy.
    files
        Files of tests.
    """

    def __init__(self, tree: Path, cache: Path, files: Sequence[str]) -> None:
        self._tree, self._cache = tree, cache
        self._own_cache = tree.with_name(tree.name + "-cache")
        for library in LIBRARIES:
            importlib.import_module(library)
        self._cold = ForkServer(tree, self._own_cache, ())
        self._warm = ForkServer(tree, self._own_cache, files)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._cold.close()
        self._warm.close()

    def baseline(self, tests: Sequence[str]) -> list[tuple[Outcome, str]]:
        """Return what becomes of tests without a mutant in each of the two processes."""
        request = Request(tests, PREPARATION_LIMIT_S)
        return [server.run(request) for server in (self._cold, self._warm)]

    def tried(
        self,
        mutant: Mutant,
        batches: Iterable[Sequence[str]],
        expected_s: float,
        *,
        is_imported: bool,
    ) -> Verdict:
        """Return what becomes of a mutant.

        Parameters
        ----------
        batches
            Tests in their order, each batch for one process; the first that fails ends the trial.
        expected_s
            Time that they take without a mutant.
        is_imported
            Whether importing the tests calls the function that is mutated.
        """
        begin_s = time.perf_counter()
        limit_s = max(PATIENCE * expected_s, LEAST_LIMIT_S)
        outcome: Outcome = "uncovered"
        test = ""
        with self._mutated(mutant) as (before, after):
            module = str(self._tree / mutant.path)
            changes = changed_functions(before, after, module)
            server = self._cold if changes is None or is_imported else self._warm
            for tests in batches:
                request = Request(tests, limit_s, module, before, after)
                outcome, test = server.run(request)
                if outcome != "survived":
                    break
        return Verdict(outcome, test, round(time.perf_counter() - begin_s, 2))

    @contextlib.contextmanager
    def _mutated(self, mutant: Mutant) -> Iterator[tuple[str, str]]:
        """Change a module, and give it a cache of links: no entry is ever written into."""
        path = self._tree / mutant.path
        original = path.read_bytes()
        before = original.decode()
        after = mutant.applied(before)
        times = path.stat()
        shutil.rmtree(self._own_cache, ignore_errors=True)
        shutil.copytree(self._cache, self._own_cache, copy_function=os.link)
        path.write_text(after, encoding="utf-8")
        try:
            yield before, after
        finally:
            path.write_bytes(original)
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def _serve(connection: Connection, tree: Path, cache: Path, files: Sequence[str]) -> None:
    """Prepare for tests in a tree, and answer requests until there are no more."""
    nowhere = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(nowhere, descriptor)
    os.chdir(tree)
    sys.path.insert(0, str(tree))
    sys.dont_write_bytecode = True
    before = os.environ.get("PYTHONPATH", "")
    os.environ |= {
        "PYTHONPATH": os.pathsep.join(filter(None, (str(tree), before))),
        "PYTHONDONTWRITEBYTECODE": "1",
        "XDG_CACHE_HOME": str(cache),
    }
    _make_examples_repeatable()
    scratch = str(tree.with_name(tree.name + "-tmp"))
    if files:
        pytest.main([*PYTEST, "--collect-only", f"--basetemp={scratch}", *files])
    while (request := connection.recv()) is not None:
        connection.send(_forked(request, scratch))


def _make_examples_repeatable() -> None:
    from hypothesis import settings

    settings.register_profile("mutation", database=None, deadline=None, derandomize=True)
    settings.load_profile("mutation")


def _forked(request: Request, scratch: str) -> tuple[Outcome, str]:
    """Run tests in a process of their own; return the outcome and the first that failed."""
    receiver, sender = FORK.Pipe(duplex=False)
    child = FORK.Process(target=_run, args=(sender, request, scratch))
    child.start()
    sender.close()
    try:
        failed = receiver.recv_bytes().decode() if receiver.poll(request.limit_s) else None
    except EOFError:
        failed = "(the process of the tests ended)"
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid or 0, signal.SIGKILL)
    child.join()
    if failed is None:
        return "timeout", ""
    return ("killed", failed) if failed else ("survived", "")


def _run(sender: Connection, request: Request, scratch: str) -> None:
    """Run tests, send which failed first, and end."""
    os.setsid()
    if request.module in _loaded_files():
        replace(changed_functions(request.before, request.after, request.module) or ())
    chosen = Chosen(request.tests)
    files = dict.fromkeys(test.partition("::")[0] for test in request.tests)
    arguments = [*PYTEST, "-x", f"--basetemp={scratch}", *files]
    code = pytest.main(arguments, plugins=[chosen])
    failed = chosen.failed or ("" if code == pytest.ExitCode.OK else f"(pytest ended with {code})")
    sender.send_bytes(failed.encode())
    os._exit(0)


def _loaded_files() -> set[str]:
    return {getattr(module, "__file__", None) or "" for module in list(sys.modules.values())}
