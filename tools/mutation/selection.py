"""The tests that are tried on a mutant: those that run its line, the nearest and fastest first."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cache
from itertools import groupby, takewhile
from pathlib import Path, PurePosixPath

from coverage import CoverageData

from mutation.covering import LINES, TIMES
from mutation.mutants import Module, Mutant, module_paths

FILE_S = 0.3
"""Time to import a file of tests, an estimate in s."""
FIRST_S = 3.0
"""Duration of the tests that are tried first."""
GROWTH = 4.0
"""Factor from the duration of the tests that are tried at once to that of the next ones."""


class Covering:
    """Knows from a folder of databases which tests run a line.

    Parameters
    ----------
    tree
        Tree that the tests ran in.
    folder
        Folder with a folder for each run of `mutation.covering`.
    """

    def __init__(self, tree: Path, folder: Path) -> None:
        self._tree = tree
        self.seconds: dict[str, float] = {}
        """Duration of each test that passes, in s."""
        self._databases: list[tuple[CoverageData, dict[str, list[str]]]] = []
        for times in sorted(folder.glob(f"*/{TIMES}")):
            by_context: defaultdict[str, list[str]] = defaultdict(list)
            for test, (seconds, contexts) in json.loads(times.read_text(encoding="utf-8")).items():
                self.seconds[test] = seconds
                for context in contexts:
                    by_context[context].append(test)
            data = CoverageData(str(times.with_name(LINES)))
            data.read()
            self._databases.append((data, by_context))
        self.tests_of = cache(self._tests_of)
        self.module = cache(self._module)
        self._functions_with = cache(lambda file, names: self.module(file).functions_with(names))
        self._paths = module_paths(tree, ["airhilt"])

    def tests(self, mutant: Mutant) -> list[set[str]]:
        """Return groups of tests that may notice a mutant, the likeliest first.

        First are those that run its line. A line that has run when its module was imported matters
        to others too: those that name what gets its value from it, those that run a line of the
        package that does, and then all that import the module or run something of it.
        """
        module = self.module(mutant.path)
        at_import = module.runs_at_import(mutant.line)
        running = set() if at_import else self._at(mutant.path, module.lines_of(mutant.line))
        if not at_import and not self.is_imported(mutant):
            return [running]
        names = module.names_made_of(module.names_given_at(mutant.line))
        naming = {test for test in self.seconds if self._names(test, names)}
        touching = self._touching(mutant.path)
        found: list[set[str]] = []
        for group in (running, naming & touching, self._using(names), naming | touching):
            found.append(group.difference(*found))
        return found

    def is_imported(self, mutant: Mutant) -> bool:
        """Return whether a mutant's line has run when modules and tests were imported."""
        lines = self.module(mutant.path).lines_of(mutant.line)
        return any(
            "" in data.contexts_by_lineno(str(self._tree / mutant.path)).get(line, ())
            for data, _ in self._databases
            for line in lines
        )

    def _names(self, test: str, names: frozenset[str]) -> bool:
        """Return whether a test, or what its file has for it, has one of some names in it."""
        return function_of(test) in self._functions_with(file_of(test), names)

    def _touching(self, path: str) -> set[str]:
        """Return the tests that run a line of a module, or whose file imports it."""
        name = path.removesuffix(".py").replace("/", ".")
        importing = {file for file in map(file_of, self.seconds) if self.module(file).imports(name)}
        running = set().union(*self.tests_of(path).values())
        return running | {test for test in self.seconds if file_of(test) in importing}

    def _using(self, names: frozenset[str]) -> set[str]:
        """Return the tests that run a line of the package with some names."""
        return set().union(
            *(self._at(path, self.module(path).lines_that_use(names)) for path in self._paths)
        )

    def _at(self, path: str, lines: Collection[int]) -> set[str]:
        by_line = self.tests_of(path) if lines else {}
        return set().union(*(by_line.get(line, ()) for line in lines))

    def _module(self, path: str) -> Module:
        return Module((self._tree / path).read_text(encoding="utf-8"))

    def _tests_of(self, path: str) -> Mapping[int, set[str]]:
        """Return the tests that run each line of a module."""
        found: defaultdict[int, set[str]] = defaultdict(set)
        for data, by_context in self._databases:
            for line, contexts in data.contexts_by_lineno(str(self._tree / path)).items():
                for context in contexts:
                    found[line].update(by_context.get(context, ()))
        return found


def file_of(test: str) -> str:
    """Return the path of the file that a test is in."""
    return test.partition("::")[0]


def function_of(test: str) -> str:
    """Return the name of the function of a test."""
    return test.partition("[")[0].rpartition("::")[2]


def ordered(path: str, tests: Iterable[str], seconds: Mapping[str, float]) -> list[str]:
    """Return tests in the order in which they are tried on a mutant of a module.

    The folder that mirrors the module's comes first, then the files that take least time. The tests
    of a file stay together, so that its fixtures are made once.
    """
    files: defaultdict[str, list[str]] = defaultdict(list)
    for test in tests:
        files[file_of(test)].append(test)
    for each in files.values():
        each.sort(key=lambda test: (seconds[test], test))

    def rank(file: str) -> tuple[int, float, str]:
        return -_nearness(path, file), sum(seconds[test] for test in files[file]), file

    return [test for file in sorted(files, key=rank) for test in files[file]]


def _nearness(path: str, test_file: str) -> int:
    """Return how many folders a module and its tests have in common."""
    parts = zip(PurePosixPath(path).parts[1:], PurePosixPath(test_file).parts[1:-1], strict=False)
    return len(list(takewhile(lambda pair: pair[0] == pair[1], parts)))


def affordable(tests: Sequence[str], seconds: Mapping[str, float], budget_s: float) -> list[str]:
    """Return the first tests that a time is enough for; the first of all in any case."""
    chosen: list[str] = []
    files: set[str] = set()
    for test in tests:
        file = file_of(test)
        cost_s = seconds[test] + (FILE_S if file not in files else 0.0)
        if not chosen or cost_s <= budget_s:
            chosen.append(test)
            files.add(file)
            budget_s -= cost_s
    return chosen


def batches(tests: Sequence[str], seconds: Mapping[str, float]) -> Iterator[list[str]]:
    """Yield tests in their order, file by file, a few first and then more and more.

    All files of a batch are imported before its first test runs, so most mutants should need no
    more than a small one.
    """
    batch: list[str] = []
    duration_s, limit_s = 0.0, FIRST_S
    for _, of_file in groupby(tests, key=file_of):
        if batch and duration_s >= limit_s:
            yield batch
            batch, duration_s, limit_s = [], 0.0, GROWTH * limit_s
        added = list(of_file)
        batch += added
        duration_s += FILE_S + sum(seconds[test] for test in added)
    if batch:
        yield batch
