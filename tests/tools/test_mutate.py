"""Mutants are drawn by seed from what the code does, and tried with the tests that run them."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

cosmic_ray = pytest.importorskip("cosmic_ray", reason="pip install -e '.[mutation]'")
pytest.importorskip("coverage", reason="pip install -e '.[mutation]'")

from mutation import covering  # noqa: E402
from mutation.functions import changed_functions, replace  # noqa: E402
from mutation.mutants import AREAS, Module, Mutant, draw, places  # noqa: E402
from mutation.score import Equivalent, Result, equivalent, table  # noqa: E402
from mutation.selection import (  # noqa: E402
    Covering,
    affordable,
    batches,
    function_of,
    ordered,
)
from mutation.trial import Outcome, Verdict  # noqa: E402

SOURCE = '''
LIMIT: int | None = 3
Pair = tuple[int | str, ...]

@marked(4)
def excess(value: int | None = 7) -> int | None:
    """Return 2."""
    if value is None:
        raise ValueError(f"{1 + 2}")
    return value - LIMIT
'''


def changes(source: str) -> set[tuple[int, str]]:
    """Return line and operator of each change that can be made."""
    return {(place[0], name) for place, found in places(source).items() for name, _ in found}


def mutant(source: str, line: int, operator: str, path: str = "module.py") -> Mutant:
    found = {(place[0], each): (each, nth, *place)
             for place, at in places(source).items() for each, nth in at}  # fmt: skip
    return Mutant("flight", path, *found[line, operator])


def test_what_the_code_does_is_changed_and_types_texts_and_errors_are_not() -> None:
    lines = {line for line, _ in changes(SOURCE)}
    assert lines == {2, 6, 8, 10}
    assert (8, "ReplaceComparisonOperator_Is_IsNot") in changes(SOURCE)
    assert (10, "ReplaceBinaryOperator_Sub_Add") in changes(SOURCE)
    assert {name for line, name in changes(SOURCE) if line in (2, 6)} == {"NumberReplacer"}


def test_the_star_before_named_parameters_multiplies_nothing() -> None:
    signature = "def of(first: int, second=2, *, third=4 * 5) -> int:\n    return first * third\n"
    stars = [
        place
        for place, found in places(signature).items()
        if any(name.startswith("ReplaceBinaryOperator_Mul") for name, _ in found)
    ]
    assert stars == [(1, signature.index("* 5")), (2, 17)]
    assert not changes("def of(*, third: int) -> int:\n    return third\n")
    defaults = {place for place in places(signature) if place[0] == 1}
    assert (1, signature.index("2,")) in defaults


def test_a_mutant_differs_in_one_place() -> None:
    changed = mutant(SOURCE, 10, "ReplaceBinaryOperator_Sub_Add").applied(SOURCE)
    assert changed == SOURCE.replace("value - LIMIT", "value + LIMIT")


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    for folders in AREAS.values():
        for name in folders:
            path = tmp_path / (name if name.endswith(".py") else f"{name}/module.py")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(SOURCE)
    return tmp_path


def test_a_seed_gives_the_same_mutants_again_as_many_of_each_area(repository: Path) -> None:
    first, again, other = (draw(repository, seed, 14) for seed in (1, 1, 2))
    assert first == again != other
    assert len(set(first)) == 14
    counts = [sum(each.area == area for each in first) for area in AREAS]
    assert sorted(counts) == [2, 2, 2, 2, 3, 3]
    for each in first:
        ast.parse(each.applied(SOURCE))


def test_a_function_that_differs_is_replaced_in_a_running_process() -> None:
    filename = "excess.py"
    source = "def outer(x):\n    def inner(y):\n        return y + 1\n    return inner(x)\n"
    namespace: dict[str, Any] = {}
    exec(compile(source, filename, "exec"), namespace)
    changed = changed_functions(source, source.replace("+", "-"), filename)
    assert changed is not None
    replace(changed)
    assert namespace["outer"](5) == 4


def test_a_function_that_was_returned_before_is_replaced_too() -> None:
    filename = "counting.py"
    source = (
        "def count(n):\n    def value(y):\n        return y + n\n    return value\nADD = count(1)\n"
    )
    namespace: dict[str, Any] = {}
    exec(compile(source, filename, "exec"), namespace)
    changed = changed_functions(source, source.replace("y + n", "y - n"), filename)
    assert changed is not None
    replace(changed)
    assert namespace["ADD"](5) == 4


@pytest.mark.parametrize(
    ("old", "new"), [("x=1", "x=2"), ("LIMIT = 3", "LIMIT = 4"), ("size = 5", "size = 6")]
)
def test_what_runs_when_a_module_is_imported_cannot_be_replaced(old: str, new: str) -> None:
    source = "LIMIT = 3\ndef f(x=1):\n    return x\nclass C:\n    size = 5\n"
    assert changed_functions(source, source.replace(old, new), "module.py") is None


def test_the_lines_of_a_condition_are_those_of_its_head_and_of_a_default_the_whole_function() -> (
    None
):
    module = Module(SOURCE)
    assert list(module.lines_of(8)) == [8]
    assert list(module.lines_of(6)) == [6, 7, 8, 9, 10]
    assert module.runs_at_import(2)
    assert not module.runs_at_import(10)
    assert module.lines_that_use(module.names_given_at(2)) == {10}
    assert Module("def f(x=LIMIT):\n    return x").lines_that_use({"LIMIT"}) == {1, 2}


PACKAGE = {
    "airhilt/__init__.py": "",
    "airhilt/levels.py": """
LIMIT_M = 3.0
LEVELS_M = (LIMIT_M, 5.0)

class Speeds:
    taxi_kt = 15.0

def tenfold(value):
    return 10 * value

WIDE_M = tenfold(4.0)

def is_near(distance_m):
    return distance_m < max(LEVELS_M)
""",
    "tests/test_levels.py": """
import pytest
from airhilt.levels import LIMIT_M, WIDE_M, Speeds, is_near, tenfold

FIELDS = ["taxi_kt"]

def test_limit():
    assert LIMIT_M == 3.0

@pytest.mark.parametrize("field", FIELDS)
def test_field(field):
    assert getattr(Speeds, field) == 15.0

def test_near():
    assert is_near(1.0)

def test_tenfold():
    assert tenfold(2) == 20

def test_wide():
    assert WIDE_M == 40.0
""",
    "tests/test_others.py": "def test_nothing():\n    pass\n",
}


@pytest.fixture(scope="module")
def covered(tmp_path_factory: pytest.TempPathFactory) -> Covering:
    """Return the covered lines of a small package.

    Its tests read constants without running a line of it.
    """
    folder = tmp_path_factory.mktemp("covered")
    for name, text in PACKAGE.items():
        path = folder / "tree" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    tests = [name for name in PACKAGE if name.startswith("tests/")]
    command = [sys.executable, covering.__file__, str(folder / "tree"), str(folder / "out" / "all")]
    subprocess.run([*command, *tests], check=True, capture_output=True)
    return Covering(folder / "tree", folder / "out")


@pytest.mark.parametrize(
    ("text", "groups"),
    [
        ("LIMIT_M = 3.0", ["", "limit", "near", "field tenfold wide"]),
        ("taxi_kt", ["", "field", "", "limit near tenfold wide"]),
        ("10 * value", ["tenfold", "wide", "", "field limit near"]),
        ("max(LEVELS_M)", ["near"]),
    ],
)
def test_what_an_import_sets_is_tried_first_with_tests_that_name_it_then_with_those_that_use_it(
    covered: Covering, text: str, groups: list[str]
) -> None:
    lines = PACKAGE["airhilt/levels.py"].splitlines()
    line = 1 + next(index for index, each in enumerate(lines) if text in each)
    tests = covered.tests(Mutant("flight", "airhilt/levels.py", "NumberReplacer", 0, line, 0))
    named = [sorted(test.partition("_")[2] for test in map(function_of, each)) for each in tests]
    assert [" ".join(each) for each in named] == groups


TESTS = {
    "tests/cosim/test_runs.py::test_all": 30.0,
    "tests/world/test_slow.py::test_b": 2.0,
    "tests/world/test_slow.py::test_a": 0.5,
    "tests/world/flight/test_near.py::test_c": 9.0,
}


def test_the_nearest_tests_come_first_and_then_the_fastest_file_by_file() -> None:
    assert ordered("airhilt/world/flight/route.py", TESTS, TESTS) == [
        "tests/world/flight/test_near.py::test_c",
        "tests/world/test_slow.py::test_a",
        "tests/world/test_slow.py::test_b",
        "tests/cosim/test_runs.py::test_all",
    ]


def test_tests_are_left_out_that_take_too_long_except_the_first() -> None:
    assert affordable(list(TESTS), TESTS, 3.0) == ["tests/cosim/test_runs.py::test_all"]
    assert affordable(list(TESTS)[1:], TESTS, 3.0) == [
        "tests/world/test_slow.py::test_b", "tests/world/test_slow.py::test_a",
    ]  # fmt: skip


def test_a_batch_grows_by_whole_files() -> None:
    order = ordered("airhilt/world/flight/route.py", TESTS, TESTS)
    assert [len(batch) for batch in batches(order, TESTS)] == [1, 3]


def result(outcome: Outcome, area: str = "flight") -> Result:
    return Result(Mutant(area, "m.py", "AddNot", 0, 1, 0), Verdict(outcome, "", 1.0), 1, 1)


def test_a_mutant_that_hangs_is_killed_and_one_that_no_test_runs_is_not() -> None:
    outcomes: tuple[Outcome, ...] = ("killed", "timeout", "survived", "uncovered")
    lines = list(table([result(outcome) for outcome in outcomes]))
    assert lines[1].split()[:4] == ["flight", "4", "2", "50.0"]
    assert lines[-1].endswith("15.0 to 85.0 %")
    assert lines[2].split() == ["radio", "0", "0", "-"]


def test_a_change_that_makes_no_difference_is_known_by_its_line() -> None:
    judged = [Equivalent("module.py", "return value + LIMIT", "LIMIT is 0")]
    plus = mutant(SOURCE, 10, "ReplaceBinaryOperator_Sub_Add")
    times = mutant(SOURCE, 10, "ReplaceBinaryOperator_Sub_Mul")
    assert equivalent(plus, SOURCE, judged) == "LIMIT is 0"
    assert equivalent(times, SOURCE, judged) is None
