"""Tests that run each line, and how long each test takes.

    python tools/mutation/covering.py TREE OUT TESTS...

runs tests of a tree in one process, and keeps in OUT a database of coverage.py with a context for
each test and each fixture that several tests share, and the times of the tests.
"""

from __future__ import annotations

import json
import os
import sys
from collections import defaultdict
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from coverage import Coverage

LINES = "lines.coverage"
"""Name of the database of coverage.py."""
TIMES = "times.json"
PYTEST = (
    *("-o", "addopts=--import-mode=importlib", "-p", "no:cacheprovider"),
    *("-q", "-W", "ignore::pytest.PytestAssertRewriteWarning"),
)
"""Options of pytest for tests in one process."""
LEFT_OUT = "not slow and not browser"
"""Tests that the default suite leaves out, and those that need a browser."""


@dataclass(frozen=True)
class Timed:
    """A test that passed: its duration, and the contexts of what it runs."""

    seconds: float
    contexts: tuple[str, ...]


class ContextSwitcher:
    """Plugin of pytest that tells coverage.py which test or shared fixture runs.

    What a fixture of a module or a session runs counts for all tests that use it, not only for the
    first one.
    """

    def __init__(self, coverage: Coverage) -> None:
        self._coverage = coverage
        self._context = ""
        self._seconds: defaultdict[str, float] = defaultdict(float)
        self._contexts: dict[str, tuple[str, ...]] = {}
        self._not_passed: set[str] = set()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None, object, object]:
        """Give a test its context."""
        fixtures: list[str] = getattr(item, "fixturenames", [])
        nodes = [node.nodeid for node in item.listchain()]
        shared = [f"{node}::{name}" for node in nodes for name in fixtures]
        self._contexts[item.nodeid] = (item.nodeid, *shared)
        return (yield from self._within(item.nodeid))

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(
        self, fixturedef: pytest.FixtureDef[Any], request: pytest.FixtureRequest
    ) -> Generator[None, object, object]:
        """Give a fixture that several tests share its context."""
        if fixturedef.scope == "function":
            return (yield)
        return (yield from self._within(f"{request.node.nodeid}::{fixturedef.argname}"))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Add up how long a test takes, and note whether it passes."""
        self._seconds[report.nodeid] += report.duration
        if report.outcome != "passed":
            self._not_passed.add(report.nodeid)

    def tests(self) -> dict[str, Timed]:
        """Return the tests that passed."""
        return {
            test: Timed(round(self._seconds[test], 4), contexts)
            for test, contexts in self._contexts.items()
            if test not in self._not_passed
        }

    def _within(self, context: str) -> Generator[None, object, object]:
        outer, self._context = self._context, context
        self._coverage.switch_context(context)
        try:
            return (yield)
        finally:
            self._context = outer
            self._coverage.switch_context(outer)


def trace(tree: Path, out: Path, tests: Sequence[str]) -> None:
    """Run files of tests, and keep what they cover."""
    os.chdir(tree)
    sys.path.insert(0, str(tree))
    out.mkdir(parents=True, exist_ok=True)
    (out / LINES).unlink(missing_ok=True)
    coverage = Coverage(
        data_file=str(out / LINES), source=["airhilt"], config_file=False, messages=False
    )
    switcher = ContextSwitcher(coverage)
    coverage.start()
    pytest.main([*PYTEST, "-m", LEFT_OUT, f"--basetemp={out / 'tmp'}", *tests], plugins=[switcher])
    coverage.stop()
    coverage.save()
    timed = {test: [each.seconds, each.contexts] for test, each in switcher.tests().items()}
    (out / TIMES).write_text(json.dumps(timed), encoding="utf-8")


if __name__ == "__main__":
    trace(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3:])
