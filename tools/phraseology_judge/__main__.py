"""Writes a corpus of radio calls as JSON lines.

    python -m tools.phraseology_judge --seed 7 --calls 1000 > calls.jsonl
    python -m tools.phraseology_judge --seed 7 --calls 1000 --error-rate 0.1 > degraded.jsonl

Each line is one call with its truth; the README beside this file describes both.
"""

from __future__ import annotations

import argparse
import json

from .calls import corpus
from .degrade import degraded


def main() -> None:
    """Print the corpus."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, default=0, help="seed of the random numbers")
    parser.add_argument("--calls", type=int, default=1000, help="number of calls")
    parser.add_argument(
        "--error-rate", type=float, default=0.0, help="share of words with a recognition error"
    )
    given = parser.parse_args()
    calls = list(corpus(given.seed, given.calls))
    if given.error_rate:
        calls = degraded(calls, given.error_rate, given.seed)
    for call in calls:
        print(json.dumps(call.as_json(), ensure_ascii=False))


if __name__ == "__main__":
    main()
