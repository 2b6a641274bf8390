"""The examples of the guide to phraseology are true."""

from __future__ import annotations

import doctest

from paths import DOCS

GUIDE = DOCS / "phraseology.md"


def test_the_examples_of_the_guide_give_what_it_says() -> None:
    failed, tried = doctest.testfile(str(GUIDE), module_relative=False, verbose=False)
    assert tried > 10
    assert failed == 0
