"""The runs of a sweep, each with its scenario and options, checked before the first of them."""

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
from airhilt.cosim.option_checks import check_options
from airhilt.cosim.requested import is_vision_measured, requested_latency, requested_radio
from airhilt.engine_families import ASSISTANTS, DETECTORS, EXTERNAL
from airhilt.errors import AirhiltError, ScenarioError, shown
from airhilt.host import library
from airhilt.options import Options
from airhilt.scenario import Scenario, loading
from airhilt.scenario.documents import require_bounded
from airhilt.scenario.problems import problems_of, validated
from airhilt.sensors.radio.backends.selection import DEFAULT_PROFILE, select_channel
from airhilt.sim import parse_latency
from airhilt.sweep.axes import listed
from airhilt.sweep.environment import Environment
from airhilt.sweep.files import NamedFiles
from airhilt.sweep.parameters import ASSISTANT as ASSISTANT_OPTION
from airhilt.sweep.parameters import Parameter, Plan, parameter
from airhilt.sweep.specification import Specification
from airhilt.world.checks import check
from airhilt.world.loading import load

REPLAY = "replay:"
"""Beginning of the latency sources that are a run, of one scenario and one seed."""
MOST_RUNS = 10_000_000
SHOWN_PROBLEMS = 20
"""Problems of a grid that one error shows."""
Json = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """One run of a sweep; the same case gives the same row on any worker.

    Attributes
    ----------
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


def cases(
    specification: Specification,
    allowed: Sequence[Path] = (),
    scenarios: LoadedScenarios | None = None,
) -> list[Case]:
    """Return the runs of a sweep, in the order of scenarios, parameters and seeds.

    Every scenario with every combination of values is checked before the first run.

    Parameters
    ----------
    allowed
        Folders besides its own in which a scenario may name files.
    scenarios
        Scenarios that other sweeps have loaded, which these runs have too; None: there are none.

    Raises
    ------
    AirhiltError
        Something is wrong with them; the message tells all of it.
    """
    known = scenarios or LoadedScenarios(allowed)
    loaded = [known.of(path) for path in _paths(specification.scenarios)]
    seeds = _seeds(specification)
    drawn = 1 if specification.sample is None else specification.sample.count
    sizes = (len(_distinct(listed(values))) for values in specification.axes.values())
    total = len(loaded) * len(seeds) * drawn * math.prod(sizes)
    if total > MOST_RUNS:
        raise AirhiltError(f"the grid has {total} runs; expected at most {MOST_RUNS}")
    combinations = list(_combinations(specification))
    checks = RunChecks(seeds)
    found: list[Case] = []
    problems: defaultdict[str, list[str]] = defaultdict(list)
    for scenario, document in loaded:
        require_different_places([each for each, _ in combinations[0]], document)
        for combination in combinations:
            try:
                begun = Plan(document, {ASSISTANT_OPTION: None, **specification.options})
                plan = _plan(scenario, begun, combination, checks)
                named = known.files.of(plan.document, plan.options)
            except AirhiltError as error:
                values = ", ".join(
                    f"{each.path}={json.dumps(value)}" for each, value in combination
                )
                where = f"{scenario.name} with {values}" if values else scenario.name
                for problem in getattr(error, "problems", (str(error),)):
                    problems[problem.removeprefix(f"{scenario.name}: ")].append(where)
                continue
            parameters = {each.path: each.value(plan) for each, _ in combination}
            found += [Case(plan.document, plan.options, seed, parameters, named) for seed in seeds]
    if problems:
        lines = [
            f"{runs[0]}: {problem}" + (f" ({len(runs) - 1} more)" if len(runs) > 1 else "")
            for problem, runs in problems.items()
        ]
        more = len(lines) - SHOWN_PROBLEMS
        tail = [f"... and {more} more"] if more > 0 else []
        raise AirhiltError("\n".join([*lines[:SHOWN_PROBLEMS], *tail]))
    return found


class LoadedScenarios:
    """Scenarios with their documents, each loaded and checked once however many sweeps have it.

    Parameters
    ----------
    allowed
        Folders besides their own in which they may name files.
    """

    def __init__(self, allowed: Sequence[Path] = ()) -> None:
        self._allowed = allowed
        self._known: dict[Path, tuple[Scenario, Json]] = {}
        self.files = NamedFiles()

    def of(self, path: Path) -> tuple[Scenario, Json]:
        """Return the scenario in a file, and its document.

        Raises
        ------
        ScenarioError
            It is not valid.
        """
        if path not in self._known:
            scenario = load(path, self._allowed)
            self._known[path] = scenario, scenario.model_dump(mode="json")
        return self._known[path]


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


def _plan(scenario: Scenario, begun: Plan, combination: Combination, checks: RunChecks) -> Plan:
    """Return a checked run of a scenario in the making, with the values of a combination."""
    plan = begun
    for each, value in combination:
        plan = each.put(plan, value)
    assistant = plan.options[ASSISTANT_OPTION] or ASSISTANTS.default
    options, is_changed = (
        plan.options | {ASSISTANT_OPTION: assistant},
        plan.document is not begun.document,
    )
    problems: list[str] = []
    try:
        scenario = _changed(plan.document) if is_changed else scenario
    except AirhiltError as error:
        problems += getattr(error, "problems", (str(error),))
    try:
        checked = Options(**options)
    except ValidationError as error:
        problems += [f"option {problem}" for problem in problems_of(error, Options)]
    if not problems:
        problems += checks.problems(checked, scenario)
    if problems:
        raise ScenarioError("\n".join(problems), tuple(problems))
    written = scenario.model_dump(mode="json") if is_changed else plan.document
    return Plan(written, checked.model_dump(mode="json", exclude_defaults=True))


def _changed(document: Json) -> Scenario:
    """Return the scenario of a document with other values, checked in its world."""
    require_bounded(document, document["name"])
    scenario = validated(Scenario, document, document["name"])
    check(scenario, scenario.name)
    return scenario


class RunChecks:
    """Says what is wrong with runs; a radio channel is loaded once however many have it."""

    def __init__(self, seeds: Sequence[int]) -> None:
        self._seeds = seeds
        self._channels: dict[str, AirhiltError | None] = {}

    def problems(self, options: Options, scenario: Scenario) -> list[str]:
        """Return all that is wrong with the runs of a scenario with some options."""
        problems = []
        for require in (check_options, self._require_assistant, self._require_latency,
                      self._require_channel):  # fmt: skip
            try:
                require(options, scenario)
            except AirhiltError as error:
                problems.append(str(error))
        return problems

    def _require_assistant(self, options: Options, _: Scenario) -> None:
        if options.assistant == EXTERNAL:
            raise AirhiltError(
                "--assistant external: no worker or program of yours attaches to the runs of a "
                "sweep, so nobody would decide; expected an assistant that `airhilt doctor` names, "
                "one of a package of yours, or the address of a service (docs/your-assistant.md)"
            )

    def _require_latency(self, options: Options, scenario: Scenario) -> None:
        is_replay = options.latency is not None and options.latency.startswith(REPLAY)
        for seed in self._seeds if is_replay else self._seeds[:1]:
            requested_latency(options.latency, scenario, seed, twin=options.twin)

    def _require_channel(self, options: Options, scenario: Scenario) -> None:
        if not options.speech:
            return
        profile = requested_radio(options, scenario).profile or DEFAULT_PROFILE
        if profile not in self._channels:
            self._channels[profile] = None
            try:
                select_channel(profile)
            except AirhiltError as error:
                self._channels[profile] = error
        if problem := self._channels[profile]:
            raise problem


def require_different_places(parameters: Sequence[Parameter], document: dict[str, Any]) -> None:
    """Complain about two parameters of which one would replace the value of the other.

    Raises
    ------
    AirhiltError
        Both are one place, or one is within the other.
    """
    places = [(each.path, place) for each in parameters if (place := each.place(document))]
    for index, (path, place) in enumerate(places):
        for other, inner in places[:index]:
            shorter = min(len(place), len(inner))
            if place[:shorter] == inner[:shorter]:
                raise AirhiltError(
                    f"parameters {other} and {path}: one would replace the other in "
                    f"{document['name']!r}; expected only one of them"
                )
