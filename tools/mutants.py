"""Mutants of documents that ship, and what becomes of each: shared by the fuzzers of files.

A mutant is a document with a few changes: a value replaced, a number scaled, a part left out,
repeated, nested, or taken from another one, sometimes text that is no JSON any more. It must be
accepted, or refused with a named error of at most 500 characters, in at most 2 s of CPU time. What
is neither is kept as a file in the folder of ``--keep``, and the exit code is 1.
"""

from __future__ import annotations

import argparse
import copy
import itertools
import json
import math
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any, Literal

import airhilt
from airhilt.errors import AirhiltError
from airhilt.host import library
from airhilt.scenario import Scenario

LONGEST_MESSAGE = 500
"""Greatest number of characters of an error."""
LONGEST_CHECK_S = 2.0
"""Greatest CPU time until a mutant is accepted or refused, in s."""
RUN_S = 1.0
"""Simulated time of the run of an accepted mutant."""

HOSTILE: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 0.5, 1e308, -1e308, 5e-324, math.nan, math.inf, 2**63, 10**40,
    "", "19", "x" * 1000, "\0", "\ud800", "\u202e", "../../etc/passwd", "ünï", [], {}, [[]],
    {"type": "time", "at_s": 1e308}, ["AAL123", "AAL123"],
)  # fmt: skip
"""Values that are put in the place of others."""

Keys = tuple[str | int, ...]
"""Keys that lead to a value in a document."""
Kind = Literal["accepted", "refused", "failed"]
Read = Callable[[str], Scenario]
"""Makes a scenario that can be run of a text, or raises an `AirhiltError`."""


@dataclass(frozen=True)
class Outcome:
    """Outcome of one mutant."""

    kind: Kind
    message: str
    cpu_s: float
    """CPU time until it was accepted or refused."""
    ran: bool = False
    """True if it was accepted, and the beginning of its scenario was run."""


class Mutator:
    """Makes mutants of documents, always the same ones for a seed."""

    def __init__(self, documents: Sequence[Any], seed: int) -> None:
        self._documents = documents
        self._random = Random(seed)

    def mutants(self) -> Iterator[str]:
        """Yield JSON texts without end."""
        changes = (self._replace, self._scale, self._delete, self._repeat, self._copy, self._nest)
        while True:
            document = copy.deepcopy(self._random.choice(self._documents))
            for _ in range(self._random.choice((1, 1, 2, 3))):
                self._random.choice(changes)(document)
            text = json.dumps(document)
            yield self._damaged(text) if self._random.random() < 0.05 else text

    def _replace(self, document: Any) -> None:
        self._put(document, self._keys(document), copy.deepcopy(self._random.choice(HOSTILE)))

    def _scale(self, document: Any) -> None:
        """Change one number."""
        numbers = [
            keys for keys, value in _values(document) if isinstance(value, int | float) and keys
        ]
        keys = self._random.choice(numbers)
        factor = self._random.choice((-1, 0, 0.5, 0.9, 1.1, 2, 10, 1e3))
        value = _value(document, keys)
        self._put(document, keys, type(value)(value * factor))

    def _delete(self, document: Any) -> None:
        keys = self._keys(document)
        if keys:
            del _value(document, keys[:-1])[keys[-1]]

    def _repeat(self, document: Any) -> None:
        """Give an entry of a list again, up to a hundred times."""
        lists = [value for _, value in _values(document) if isinstance(value, list) and value]
        if lists:
            entries = self._random.choice(lists)
            entries += [self._random.choice(entries)] * self._random.choice((1, 2, 100))

    def _copy(self, document: Any) -> None:
        """Put a value of any document where there is another of its type."""
        there = self._random.choice(self._documents)
        value = copy.deepcopy(_value(there, self._keys(there)))
        places = [keys for keys, old in _values(document) if type(old) is type(value) and keys]
        if places:
            self._put(document, self._random.choice(places), value)

    def _nest(self, document: Any) -> None:
        """Put an object into conditions within each other."""
        objects = [keys for keys, value in _values(document) if isinstance(value, dict) and keys]
        if not objects:
            return
        keys = self._random.choice(objects)
        value = _value(document, keys)
        for _ in range(self._random.choice((1, 3, 10, 50))):
            value = {"type": "all_of", "conditions": [value]}
        self._put(document, keys, value)

    def _damaged(self, text: str) -> str:
        """Return a text that may be no JSON any more."""
        at = self._random.randrange(len(text))
        inserted = self._random.choice(("", "{", "]", '"', "9" * 5000, "[" * 100_000, '"a":1,'))
        return text[:at] + inserted + text[at + self._random.randrange(3) :]

    def _keys(self, document: Any) -> Keys:
        return self._random.choice([keys for keys, _ in _values(document)])

    def _put(self, document: Any, keys: Keys, value: Any) -> None:
        if keys:
            _value(document, keys[:-1])[keys[-1]] = value


def _values(value: Any, keys: Keys = ()) -> Iterator[tuple[Keys, Any]]:
    """Yield all values inside a document, and the document, with their keys."""
    yield keys, value
    inside = value.items() if isinstance(value, dict) else ()
    for key, inner in enumerate(value) if isinstance(value, list) else inside:
        yield from _values(inner, (*keys, key))


def _value(document: Any, keys: Keys) -> Any:
    for key in keys:
        document = document[key]
    return document


def shipped(kind: str, names: Sequence[str] | None = None) -> list[Any]:
    """Return documents of a kind that ship, such as scenarios; all of them without names."""
    return [
        json.loads(library.find(kind, name).read_text(encoding="utf-8"))
        for name in names or library.names(kind)
    ]


def judge(text: str, read: Read, runs: bool, longest_check_s: float = LONGEST_CHECK_S) -> Outcome:
    """Return what becomes of a text that may be a document.

    Parameters
    ----------
    runs
        Whether the beginning of its scenario is run if it is accepted.
    longest_check_s
        Greatest CPU time until it is accepted or refused, in s.
    """
    begin_s = time.process_time()
    scenario: Scenario | None = None
    kind: Kind = "accepted"
    message = ""
    try:
        scenario = read(text)
    except AirhiltError as error:
        message = str(error)
        kind = "failed" if len(message) > LONGEST_MESSAGE else "refused"
    except Exception:
        kind, message = "failed", traceback.format_exc()
    cpu_s = time.process_time() - begin_s
    if cpu_s > longest_check_s:
        message = f"checked for {cpu_s:.1f} s of CPU time: {message or kind}"
        return Outcome("failed", message, cpu_s)
    if scenario is None or not runs:
        return Outcome(kind, message, cpu_s)
    failure = _run(scenario)
    return Outcome("failed" if failure else "accepted", failure or "", cpu_s, ran=True)


def judge_many(
    documents: Sequence[Any],
    read: Read,
    seed: int,
    count: int,
    run_every: int,
    longest_check_s: float = LONGEST_CHECK_S,
) -> Iterator[tuple[str, Outcome]]:
    """Yield mutants and what becomes of them.

    Parameters
    ----------
    run_every
        One of so many that are accepted is run, the first one too; 0: none.
    """
    accepted = 0
    for text in itertools.islice(Mutator(documents, seed).mutants(), count):
        runs = run_every > 0 and accepted % run_every == 0
        outcome = judge(text, read, runs, longest_check_s)
        accepted += outcome.kind == "accepted"
        yield text, outcome


def _run(scenario: Scenario) -> str | None:
    """Run the beginning of a scenario; return what went wrong."""
    short = scenario.model_copy(update={"duration_s": min(scenario.duration_s, RUN_S)})
    with tempfile.TemporaryDirectory() as folder:
        try:
            airhilt.run(
                short, out=Path(folder) / "run", latency="fixed", cameras=False, speech=False
            )
        except Exception:
            return traceback.format_exc()
    return None


def fuzz(kind: str, read: Read, description: str) -> int:
    """Judge mutants as the command line says; print how many came to what, and the slowest check.

    Parameters
    ----------
    kind
        Folder of the documents that ship.
    """
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=10_000, help="number of mutants")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--names", help="documents, separated by commas; all if missing")
    parser.add_argument(
        "--run-every", type=int, default=1, help="run each N-th accepted mutant; 0: none"
    )
    parser.add_argument("--keep", type=Path, help="folder for the mutants that failed")
    given = parser.parse_args()
    documents = shipped(kind, given.names.split(",") if given.names else None)
    kinds: Counter[Kind] = Counter()
    slowest_s = 0.0
    judged = judge_many(documents, read, given.seed, given.count, given.run_every)
    for number, (text, outcome) in enumerate(judged):
        kinds[outcome.kind] += 1
        slowest_s = max(slowest_s, outcome.cpu_s)
        if outcome.kind == "failed":
            print(f"mutant {number}: {outcome.message}", file=sys.stderr)
            if given.keep is not None:
                given.keep.mkdir(parents=True, exist_ok=True)
                (given.keep / f"{number}.json").write_text(text, encoding="utf-8")
    counts = ", ".join(f"{kinds[kind]} {kind}" for kind in ("accepted", "refused", "failed"))
    print(f"seed {given.seed}: {counts}; the slowest check took {slowest_s:.2f} s of CPU")
    return 1 if kinds["failed"] else 0
