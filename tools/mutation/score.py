"""The share of mutants that the tests notice, by area."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from scipy.stats import binomtest

from mutation.mutants import AREAS, Mutant
from mutation.trial import Verdict

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Result:
    """A mutant, what became of it, and how many of the tests that run its line were tried."""

    mutant: Mutant
    verdict: Verdict
    tried: int
    covering: int

    @property
    def is_killed(self) -> bool:
        """True if a test failed, or hung."""
        return self.verdict.outcome in ("killed", "timeout")


def append(path: Path, result: Result) -> None:
    """Add a result to a file of JSON lines."""
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(asdict(result)) + "\n")


def read(path: Path) -> list[Result]:
    """Return the results of a file; of a mutant that was tried again, the last one."""
    if not path.exists():
        return []
    found: dict[Mutant, Result] = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        given = json.loads(line)
        mutant = Mutant(**given["mutant"])
        verdict = Verdict(**given["verdict"])
        found[mutant] = Result(mutant, verdict, given["tried"], given["covering"])
    return list(found.values())


@dataclass(frozen=True)
class Equivalent:
    """A change that cannot be noticed: a module, its changed line, and the reason."""

    path: str
    line: str
    reason: str


def read_equivalents(path: Path) -> list[Equivalent]:
    """Return the changes that were judged to make no difference."""
    return [Equivalent(**given) for given in json.loads(path.read_text(encoding="utf-8"))]


def equivalent(mutant: Mutant, source: str, judged: Iterable[Equivalent]) -> str | None:
    """Return why a change of a module makes no difference; None if that is not known."""
    changed = [text[1:].strip() for text in difference(mutant, source) if text.startswith("+")]
    for each in judged:
        if each.path == mutant.path and [each.line] == changed:
            return each.reason
    return None


def difference(mutant: Mutant, source: str) -> list[str]:
    """Return the lines that a mutant takes out and puts in, with their signs."""
    lines = difflib.unified_diff(
        source.splitlines(), mutant.applied(source).splitlines(), n=0, lineterm=""
    )
    return [line for line in lines if line[:3] not in ("---", "+++") and not line.startswith("@@")]


def table(results: Sequence[Result]) -> Iterator[str]:
    """Yield the lines of a table with the score of each area and of all."""
    yield f"{'area':14}{'mutants':>8}{'killed':>8}{'share':>8}  95 % interval (Wilson)"
    for area in (*AREAS, "all"):
        of_area = [result for result in results if area in ("all", result.mutant.area)]
        killed = sum(result.is_killed for result in of_area)
        yield f"{area:14}{len(of_area):8}{killed:8}{_share(killed, len(of_area))}"


def _share(killed: int, count: int) -> str:
    if not count:
        return f"{'-':>8}"
    interval = binomtest(killed, count).proportion_ci(CONFIDENCE, method="wilson")
    low, high = 100.0 * interval.low, 100.0 * interval.high
    return f"{100.0 * killed / count:6.1f} %  {low:.1f} to {high:.1f} %"
