"""Changes the code a little, one place at a time, and counts how often the tests notice.

    python tools/mutate.py --count 500 --seed 20 --folder mutation
    python tools/mutate.py --folder mutation --show
    python tools/mutate.py --folder mutation --again --budget 600

Needs `pip install -e '.[mutation]'`, and about two hours of one core for 500. It works on copies of
the tree in the folder. The first command runs the tests once to know which of them run which line,
draws mutants in equal numbers from the areas of `mutation.mutants.AREAS`, and tries each with the
tests that run its line, or those that a value from its import matters to. When it was stopped, it
goes on when it is given again. ``--again`` tries what survived with more tests.

A mutant is killed if a test fails or hangs. Only tests of the folders in `TESTS` are tried, those
that are not slow and need no browser.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import standard_output
from mutation import covering, score
from mutation.mutants import Mutant, draw
from mutation.score import Result
from mutation.selection import Covering, affordable, batches, file_of, ordered
from mutation.trial import Bench

ROOT = Path(__file__).resolve().parents[1]
TESTS = (
    "sensors", "sensors/radio", "metrics", "world", "world/truth", "world/flight", "world/actors",
    "assistant", "assistant/decision", "assistant/wording", "assistant/asr",
    "assistant/enhancement", "assistant/tts", "assistant/vision", "phraseology", "surveillance",
    "geodesy", "sim", "workers", "scenario", "audio", "voices",
)  # fmt: skip
"""Folders of tests that are tried, without the folders in them."""
UNMUTATED = "tests/surveillance/test_cpr.py"
"""Tests that must pass before mutants are tried."""
RESULTS = "results.jsonl"
EQUIVALENTS = Path(__file__).parent / "mutation" / "equivalent.json"
"""Mutants that were judged to make no difference, with the reason of each."""


def main() -> None:
    """Draw mutants, try those that were not tried, and print the score and the survivors."""
    given = _arguments()
    folder: Path = given.folder.resolve()
    results = folder / RESULTS
    if not given.show:
        mutants = _drawn(folder, given.seed, given.count)
        _map(folder)
        tried = score.read(results)
        done = {each.mutant for each in tried if each.is_killed or not given.again}
        if given.again:
            mutants = [each.mutant for each in tried]
        index, parts = map(int, given.part.split("/"))
        waiting = [mutant for mutant in mutants if mutant not in done]
        _try_all(folder, waiting[index - 1 :: parts], given.budget, given.part)
    _show(folder, score.read(results))


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=500, help="number of mutants")
    parser.add_argument("--seed", type=int, default=20)
    parser.add_argument("--folder", type=Path, required=True, help="for copies and results")
    parser.add_argument("--budget", type=float, default=20.0, help="seconds of tests of a mutant")
    parser.add_argument("--part", default="1/1", metavar="I/N", help="try each N-th, from the I-th")
    parser.add_argument("--again", action="store_true", help="try what survived once more")
    parser.add_argument("--show", action="store_true", help="print what is known, and try nothing")
    return parser.parse_args()


def _drawn(folder: Path, seed: int, count: int) -> list[Mutant]:
    """Return the mutants of a folder, drawn and written there if there are none yet."""
    kept = folder / "mutants.json"
    if not kept.exists():
        _copy_tree(folder / "tree")
        drawn = draw(folder / "tree", seed, count)
        kept.write_text(json.dumps([asdict(each) for each in drawn]), encoding="utf-8")
    return [Mutant(**each) for each in json.loads(kept.read_text(encoding="utf-8"))]


def _copy_tree(tree: Path) -> None:
    """Copy what git knows of the repository, as it is now."""
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True)
    for name in filter(None, names.stdout.decode().split("\0")):
        if (ROOT / name).is_file():
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, tree / name)


def _map(folder: Path) -> None:
    """Run the tests that were not run yet, and keep which lines they run."""
    tree = folder / "tree"
    variables = os.environ | {"XDG_CACHE_HOME": str(folder / "cache")}
    variables["PYTHONPATH"] = os.pathsep.join([str(tree), os.environ.get("PYTHONPATH", "")])
    for name in TESTS:
        out = folder / "covered" / name.replace("/", ".")
        files = [str(path.relative_to(tree)) for path in (tree / "tests" / name).glob("test_*.py")]
        if not files or (out / covering.TIMES).exists():
            continue
        print(f"running the tests of {name} with coverage", flush=True)
        command = [sys.executable, covering.__file__, str(tree), str(out), *sorted(files)]
        subprocess.run(command, env=variables, stdout=subprocess.DEVNULL, check=True)


def _try_all(folder: Path, mutants: Sequence[Mutant], budget_s: float, part: str) -> None:
    """Try mutants, and keep each result when it is there."""
    covered = Covering(folder / "tree", folder / "covered")
    tree = folder / f"tree-{part.replace('/', '-of-')}"
    shutil.rmtree(tree, ignore_errors=True)
    shutil.copytree(folder / "tree", tree)
    files = sorted({file_of(test) for test in covered.seconds})
    with Bench(tree, folder / "cache", files) as bench:
        baseline = bench.baseline([test for test in covered.seconds if test.startswith(UNMUTATED)])
        if set(baseline) != {("survived", "")}:
            sys.exit(f"{UNMUTATED} without a mutant: {baseline}; expected it to pass")
        for number, mutant in enumerate(mutants, start=1):
            tests = [
                test
                for group in covered.tests(mutant)
                for test in ordered(mutant.path, group, covered.seconds)
            ]
            chosen = affordable(tests, covered.seconds, budget_s)
            expected_s = sum(covered.seconds[test] for test in chosen)
            verdict = bench.tried(
                mutant,
                batches(chosen, covered.seconds),
                expected_s,
                is_imported=covered.is_imported(mutant),
            )
            score.append(folder / RESULTS, Result(mutant, verdict, len(chosen), len(tests)))
            place = f"{mutant.path}:{mutant.line} {mutant.operator}"
            progress = f"{number}/{len(mutants)} {verdict.outcome:9} {verdict.wall_s:6.1f} s"
            print(progress, place, verdict.test, flush=True)


def _show(folder: Path, results: Sequence[Result]) -> None:
    """Print what survived, and the score with and without what makes no difference."""
    equivalents = score.read_equivalents(EQUIVALENTS)
    counted = []
    for result in results:
        mutant = result.mutant
        source = (folder / "tree" / mutant.path).read_text(encoding="utf-8")
        reason = None if result.is_killed else score.equivalent(mutant, source, equivalents)
        if reason is None:
            counted.append(result)
        if not result.is_killed:
            tests = f"{result.tried} of {result.covering} tests"
            print(f"{mutant.path}:{mutant.line} {result.verdict.outcome}, {tests}")
            print(*score.difference(mutant, source), sep="\n")
            print(f"  equivalent: {reason}\n" if reason else "")
    print(*score.table(results), sep="\n")
    print("without those that make no difference:")
    print(*score.table(counted), sep="\n")


if __name__ == "__main__":
    standard_output.run(main)
