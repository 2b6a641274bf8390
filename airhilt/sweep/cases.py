"""The runs of a sweep: each with its scenario, its options and a key that tells them apart."""

from __future__ import annotations

import fnmatch
import hashlib
import itertools
import json
import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import JsonValue, ValidationError

from airhilt.cosim.latency_presets import PRESETS
from airhilt.cosim.requested import is_vision_measured
from airhilt.engine_families import ASSISTANTS, DETECTORS
from airhilt.errors import AirhiltError, ScenarioError, shown
from airhilt.host import library
from airhilt.options import Options
from airhilt.scenario import Scenario, loading
from airhilt.scenario.documents import require_bounded
from airhilt.scenario.problems import error_for, problems_of
from airhilt.sim import parse_latency
from airhilt.sweep.axes import listed
from airhilt.sweep.checks import RunChecks, require_different_places
from airhilt.sweep.environment import Environment
from airhilt.sweep.files import NamedFiles
from airhilt.sweep.parameters import ASSISTANT as ASSISTANT_OPTION
from airhilt.sweep.parameters import Parameter, Plan, parameter
from airhilt.sweep.specification import Specification
from airhilt.world.checks import check
from airhilt.world.loading import load

MOST_RUNS = 10_000_000
SHOWN_PROBLEMS = 20
"""Problems of a grid that one error shows."""
Json = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """One run of a sweep; the same case gives the same row on any worker.

    Attributes
    ----------
    document
        The scenario, with the values of the parameters in it.
    options
        Options of the run that differ from their defaults, as JSON has them.
    parameters
        Value of each parameter of the grid, by its path.
    files
        SHA-256 of each file or folder that scenario or options name, by the text that names it.
    """

    document: Json
    options: Json
    seed: int
    parameters: dict[str, JsonValue]
    files: Mapping[str, str] = field(default_factory=dict)

    @property
    def scenario(self) -> str:
        """Name of the scenario."""
        return str(self.document["name"])

    @property
    def family(self) -> str:
        """Family of the scenario, empty if it has none."""
        return str(self.document["family"] or "")

    @property
    def assistant(self) -> str:
        """Name of who decides."""
        return str(self.options[ASSISTANT_OPTION])

    @property
    def has_cameras(self) -> bool:
        """True if pictures are taken."""
        return bool(self.options.get("cameras", True) and self.document["cameras"])

    @property
    def may_share_pictures(self) -> bool:
        """True if the run is the same whoever draws its pictures and looks at them."""
        latency = parse_latency(self.options.get("latency"), PRESETS)
        detector = self.options.get("detector", DETECTORS.default)
        return self.has_cameras and not is_vision_measured(latency, detector)

    def key(self, environment: Environment) -> str:
        """Return the SHA-256 of all that decides the result of this run, in hexadecimal."""
        whole = {
            "scenario": self.document,
            "options": self.options,
            "seed": self.seed,
            "files": dict(self.files),
            "environment": environment.model_dump(),
        }
        text = json.dumps(whole, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()


def cases(specification: Specification, allowed: Sequence[Path] = ()) -> list[Case]:
    """Return the runs of a sweep, in the order of scenarios, parameters and seeds.

    Every scenario with every combination of values is checked before the first run.

    Parameters
    ----------
    allowed
        Folders besides its own in which a scenario may name files.

    Raises
    ------
    AirhiltError
        Something is wrong with them; the message tells all of it.
    """
    scenarios = [load(path, allowed) for path in _paths(specification.scenarios)]
    seeds = _seeds(specification)
    _require_countable(specification, len(scenarios) * len(seeds))
    combinations = list(_combinations(specification))
    checks, files = RunChecks(seeds), NamedFiles()
    found: list[Case] = []
    problems: defaultdict[str, list[str]] = defaultdict(list)
    for scenario in scenarios:
        document = scenario.model_dump(mode="json")
        require_different_places([each for each, _ in combinations[0]], document)
        for combination in combinations:
            try:
                plan = _plan(document, specification.options, combination, checks)
                named = files.of(plan.document, plan.options)
            except AirhiltError as error:
                for problem in getattr(error, "problems", (str(error),)):
                    told = problem.removeprefix(f"{scenario.name}: ")
                    problems[told].append(_named(scenario.name, combination))
                continue
            parameters = {each.path: each.value(plan) for each, _ in combination}
            found += [Case(plan.document, plan.options, seed, parameters, named) for seed in seeds]
    _require_none(problems)
    return found


def _paths(patterns: Sequence[str]) -> list[Path]:
    """Return the files of the scenarios that names, patterns and paths mean, each once."""
    found: dict[Path, None] = {}
    names = library.names("scenarios")
    for pattern in patterns:
        if any(mark in pattern for mark in "*?[") and not Path(pattern).exists():
            matching = fnmatch.filter(names, pattern)
            if not matching:
                raise ScenarioError(
                    f"no scenario matches {pattern!r}{library.nearest(pattern, names)}"
                )
            found |= {loading.find(name): None for name in matching}
        else:
            found[loading.find(pattern)] = None
    return list(found)


def _seeds(specification: Specification) -> list[int]:
    seeds = list(dict.fromkeys(listed(specification.seeds)))
    for seed in seeds:
        if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < 2**63:
            raise AirhiltError(f"seeds: found {shown(seed)}; expected integers from 0 to 2^63 - 1")
    return seeds  # type: ignore[return-value]  # checked one by one


def _require_countable(specification: Specification, each: int) -> None:
    """Complain about more runs than a sweep may have, before any of them is made.

    Parameters
    ----------
    each
        Number of runs of one combination: scenarios times seeds.
    """
    drawn = 1 if specification.sample is None else specification.sample.count
    sizes = (len(_distinct(listed(values))) for values in specification.axes.values())
    total = each * drawn * math.prod(sizes)
    if total > MOST_RUNS:
        raise AirhiltError(f"the grid has {total} runs; expected at most {MOST_RUNS}")


Combination = tuple[tuple[Parameter, JsonValue], ...]


def _combinations(specification: Specification) -> Iterator[Combination]:
    """Yield every combination of values of the axes with every point that is drawn."""
    axes = [(parameter(path), _distinct(listed(v))) for path, v in specification.axes.items()]
    drawn = [] if specification.sample is None else specification.sample.points()
    of_sample = [parameter(path) for path in drawn[0]] if drawn else []
    given = [parameter(name) for name in specification.options]
    paths = [each.path for each in (*of_sample, *(each for each, _ in axes), *given)]
    twice = sorted({path for path in paths if paths.count(path) > 1})
    if twice:
        raise AirhiltError(f"parameter {twice[0]}: given twice; expected once")
    for point in drawn or [{}]:
        values = tuple(zip(of_sample, point.values(), strict=True))
        for chosen in itertools.product(*(v for _, v in axes)):
            yield (*values, *zip((each for each, _ in axes), chosen, strict=True))


def _distinct(values: Sequence[JsonValue]) -> list[JsonValue]:
    """Return values without those that come again; 5 and 5.0 are one."""
    first: dict[object, JsonValue] = {}
    for value in values:
        is_number = isinstance(value, int | float)
        first.setdefault((type(value) is bool, value) if is_number else json.dumps(value), value)
    return list(first.values())


def _require_none(problems: Mapping[str, Sequence[str]]) -> None:
    """Complain about the problems of a grid, each with the first of the runs that have it.

    Parameters
    ----------
    problems
        Runs by the problem that they have.

    Raises
    ------
    AirhiltError
        There are some.
    """
    lines = [
        f"{where[0]}: {problem}" + (f" ({len(where) - 1} more)" if len(where) > 1 else "")
        for problem, where in problems.items()
    ]
    if lines:
        more = len(lines) - SHOWN_PROBLEMS
        tail = [f"... and {more} more"] if more > 0 else []
        raise AirhiltError("\n".join([*lines[:SHOWN_PROBLEMS], *tail]))


def _named(scenario: str, combination: Combination) -> str:
    """Return the runs of a scenario with some values in words."""
    values = ", ".join(f"{each.path}={json.dumps(value)}" for each, value in combination)
    return f"{scenario} with {values}" if values else scenario


def _plan(document: Json, options: Json, combination: Combination, checks: RunChecks) -> Plan:
    """Return a checked run in the making; options are those that were given, as JSON has them.

    Raises
    ------
    AirhiltError
        A value is not what the scenario or the option takes.
    """
    plan = Plan(document, {ASSISTANT_OPTION: None, **options})
    for each, value in combination:
        plan = each.put(plan, value)
    assistant = plan.options[ASSISTANT_OPTION] or ASSISTANTS.default
    plan = Plan(plan.document, plan.options | {ASSISTANT_OPTION: assistant})
    problems: list[str] = []
    try:
        scenario = _scenario(plan.document, is_changed=plan.document is not document)
    except AirhiltError as error:
        problems += getattr(error, "problems", (str(error),))
    try:
        checked = Options(**plan.options)
    except ValidationError as error:
        problems += [f"option {problem}" for problem in problems_of(error, Options)]
    if not problems:
        problems += checks.problems(checked, scenario)
    if problems:
        raise ScenarioError("\n".join(problems), tuple(problems))
    written = scenario.model_dump(mode="json") if plan.document is not document else document
    return Plan(written, checked.model_dump(mode="json", exclude_defaults=True))


def _scenario(document: Json, *, is_changed: bool) -> Scenario:
    """Return the scenario of a document; one that is changed is checked in its world again."""
    require_bounded(document, document["name"])
    try:
        scenario = Scenario.model_validate(document)
    except ValidationError as error:
        raise error_for(document["name"], problems_of(error, Scenario)) from None
    if is_changed:
        check(scenario, scenario.name)
    return scenario
