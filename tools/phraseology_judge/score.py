"""Scores the parser of the project on a corpus of the judge.

    python -m tools.phraseology_judge --seed 7 --calls 1000 > calls.jsonl
    python -m tools.phraseology_judge.score calls.jsonl
    python -m tools.phraseology_judge.score calls.jsonl --json

The README beside this file says what is counted.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from airhilt.phraseology import TAU_ASR, parse_call

from .facts import CLEARANCES, VALUES, Fact, also_right, facts_of_call, facts_of_items
from .vocabulary import KINDS

INSTRUCTED = frozenset({"now", "conditional", "readback", "expected", "information"})
"""Statuses of the items that are to be read."""
TRUE = INSTRUCTED | {"report"}
"""Statuses of the items that may be read: a pilot who reports a level flies it."""


@dataclass(slots=True)
class Kind:
    """Counts of one kind of item."""

    said: int = 0
    right: int = 0
    wrong: int = 0
    """Facts of this kind in effect that were read with confidence and are not true."""


@dataclass(slots=True)
class Score:
    """Counts of a corpus."""

    calls: int = 0
    callsign_right: int = 0
    items: int = 0
    items_right: int = 0
    wrong_and_confident: int = 0
    """Calls with a callsign or an instruction in effect that is confident and not true."""
    acted_upon: int = 0
    """Calls with an instruction in effect that is confident."""
    acted_upon_wrongly: int = 0
    """Calls among them of which one such instruction is not true."""
    only_unnamed: int = 0
    """Calls among them that are wrong only in kinds that the vocabulary of the judge lacks."""
    wrong_callsigns: int = 0
    """Calls with a confident and wrong callsign."""
    invented: int = 0
    """Calls with a clearance that was not given, whatever its confidence."""
    invented_and_confident: int = 0
    kinds: dict[str, Kind] = field(default_factory=dict)
    out_of_scope: Counter[str] = field(default_factory=Counter)

    def kind(self, name: str) -> Kind:
        """Return the counts of a kind."""
        return self.kinds.setdefault(name, Kind())

    def take(self, line: dict[str, Any]) -> None:
        """Count one call: a line of the corpus, or what a recogniser made of it.

        The latter has its ``word_confidences`` beside its text.
        """
        call = parse_call(line["text"], line["roster"], line.get("word_confidences"))
        truth = list(facts_of_items(line["items"]))
        self.calls += 1
        self.callsign_right += call.callsign == line["callsign"]
        self.out_of_scope.update(
            item["kind"] for item in line["items"] if item["kind"] not in VALUES
        )
        read = list(facts_of_call(call))
        self._take_items(truth, {fact for fact, _ in read} | set(also_right(call)))
        true = {fact for fact, status in truth if status in TRUE}
        certain = {fact for fact, sure in read if sure >= TAU_ASR and _in_effect(fact)}
        untrue = certain - true
        self.acted_upon += bool(certain)
        self.acted_upon_wrongly += bool(untrue)
        for fact in untrue:
            self.kind(fact.kind).wrong += 1
        wrong_name = call.callsign not in (None, line["callsign"]) and call.match.score >= TAU_ASR
        self.wrong_callsigns += wrong_name
        self.wrong_and_confident += bool(untrue or wrong_name)
        self.only_unnamed += bool(untrue) and not (
            wrong_name or any(fact.kind in KINDS for fact in untrue)
        )
        self.invented += _invents((fact for fact, _ in read), true)
        self.invented_and_confident += _invents(
            (fact for fact, sure in read if sure >= TAU_ASR), true
        )

    def _take_items(self, truth: list[tuple[Fact, str]], read: set[Fact]) -> None:
        for fact, status in truth:
            if status not in INSTRUCTED:
                continue
            counts = self.kind(fact.kind)
            counts.said += 1
            counts.right += fact in read
            self.items += 1
            self.items_right += fact in read

    def shares(self) -> dict[str, float]:
        """Return the measures."""
        return {
            "callsign_right": self.callsign_right / self.calls,
            "action_and_value_right": self.items_right / self.items,
            "wrong_and_confident": self.wrong_and_confident / self.calls,
            "of_these_in_kinds_unnamed": self.only_unnamed / self.calls,
            "wrong_callsign_and_confident": self.wrong_callsigns / self.calls,
            "clearance_invented": self.invented / self.calls,
            "clearance_invented_and_confident": self.invented_and_confident / self.calls,
        }


def _in_effect(fact: Fact) -> bool:
    return fact.status in ("now", "information")


def _invents(read: Iterable[Fact], true: set[Fact]) -> bool:
    """Return whether a clearance was read that the call does not give, or gives conditionally."""
    given = {(fact.kind, fact.status) for fact in true}
    return any(
        fact.kind in CLEARANCES
        and fact.status in ("now", "conditional")
        and (fact.kind, fact.status) not in given
        and (fact.status == "now" or (fact.kind, "now") not in given)
        for fact in read
    )


def score(lines: Iterable[dict[str, Any]]) -> Score:
    """Return the counts of calls and their truth."""
    counts = Score()
    for line in lines:
        counts.take(line)
    return counts


def main() -> None:
    """Print the score of a corpus."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("corpus", type=Path, metavar="FILE.jsonl")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    given = parser.parse_args()
    counts = score(json.loads(line) for line in given.corpus.read_text().splitlines())
    if given.json:
        kinds = {name: asdict(each) for name, each in sorted(counts.kinds.items())}
        left = dict(sorted(counts.out_of_scope.items()))
        print(json.dumps({**counts.shares(), "kinds": kinds, "out_of_scope": left}, indent=2))
        return
    for name, share in counts.shares().items():
        print(f"{name:34} {share:7.1%}")
    print(f"\n{'kind':24} {'said':>6} {'right':>6} {'wrong':>6}")
    for name, each in sorted(counts.kinds.items()):
        print(f"{name:24} {each.said:6} {each.right:6} {each.wrong:6}")
    print("\nnot scored: " + ", ".join(f"{k} {n}" for k, n in sorted(counts.out_of_scope.items())))


if __name__ == "__main__":
    main()
