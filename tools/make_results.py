"""Makes docs/results.md and the pages of its sections: runs, tables, figures, hashes, commit.

    python tools/make_results.py                    run what is missing, and make the pages
    python tools/make_results.py --page-only        make the pages of what is there
    python tools/make_results.py --only paper       run one section, and make the pages
    python tools/make_results.py --seeds 5 --encounters 200
    python tools/make_results.py --cameras          with cameras, which takes far longer

It says what it will take before it begins. The same command goes on where it was stopped. The texts
of the pages are in tools/results, its sections in tools/results/sections.py.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from airhilt.cli.output import tell
from airhilt.cli.parameters import INTERRUPTED
from airhilt.cli.sweep_output import duration
from airhilt.errors import AirhiltError
from airhilt.host.text import counted
from results.page import Page
from results.record import ROOT, current_code, write_code
from results.sections import SECTIONS, Section, Wanted

INCOMPLETE = 1
"""Exit status if runs failed; the page says how many."""


def main(words: Sequence[str] | None = None) -> int:
    """Make the page; a user's mistake ends with one line and exit code 2."""
    given = _given(words)
    try:
        return _make(given)
    except AirhiltError as error:
        tell(str(error))
        return error.exit_code
    except KeyboardInterrupt:
        tell("interrupted; the same command goes on")
        return INTERRUPTED


def _given(words: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    names = [each.name for each in SECTIONS]
    parser.add_argument(
        "--work", type=Path, default=ROOT / "evaluations" / "results", metavar="DIR"
    )
    parser.add_argument("--page", type=Path, default=ROOT / "docs" / "results.md", metavar="FILE")
    parser.add_argument("--seeds", type=int, metavar="N", help="seeds of every evaluation")
    parser.add_argument("--encounters", type=int, default=1000, metavar="N")
    parser.add_argument("--cameras", action="store_true", help="with cameras")
    parser.add_argument("--workers", type=int, metavar="N", help="number of local workers")
    parser.add_argument("--only", choices=names, help="run one section; the others stay")
    parser.add_argument("--page-only", action="store_true", help="run nothing")
    parser.add_argument(
        "--dirty", action="store_true", help="allow and show numbers of uncommitted changes"
    )
    return parser.parse_args(words)


def _make(given: argparse.Namespace) -> int:
    is_complete = True
    if not given.page_only:
        code = current_code(allows_dirty=given.dirty)
        wanted = Wanted(
            given.work, code, given.seeds, given.encounters, given.cameras, given.workers
        )
        chosen = [each for each in SECTIONS if given.only in (None, each.name)]
        _tell_sizes(chosen, wanted)
        for section in chosen:
            made = section.make(wanted)
            if made is not None:
                is_complete &= made
                write_code(given.work / section.name, code)
    Page.of(SECTIONS, given.work, given.dirty).write(given.page)
    tell(f"wrote {given.page}")
    return 0 if is_complete else INCOMPLETE


def _tell_sizes(sections: Sequence[Section], wanted: Wanted) -> None:
    """Say how many runs there are, and how long those that are left take."""
    total_s = 0.0
    for section in sections:
        size = section.size(wanted)
        total_s += size.left_s or 0.0
        time = "not estimated" if size.left_s is None else f"about {duration(size.left_s)}"
        tell(f"{section.name}: {counted(size.runs, 'run')}, {size.left} of them left, {time}")
    tell(f"all: about {duration(total_s)}")


if __name__ == "__main__":
    sys.exit(main())
