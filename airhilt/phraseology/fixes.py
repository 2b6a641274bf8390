"""Names of fixes that the caller knows."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

from airhilt.phraseology.words import Words, tokens

Names = dict[str, tuple[tuple[str, ...], ...]]


def with_fixes(words: Words, fixes: Iterable[str]) -> Words:
    """Return words in which each known fix is one word that ends with an underscore.

    So its words are no instruction, and no other word is part of its name: ``deer_park_``.
    """
    names = _by_first_word(tuple(fixes))
    if not names:
        return words
    joined = Words()
    at, size = 0, len(words.texts)
    while at < size:
        known = names.get(words.texts[at], ())
        name = next(
            (each for each in known if tuple(words.texts[at : at + len(each)]) == each), None
        )
        if name is None:
            joined.add(words.texts[at], words.confidences[at])
            at += 1
            continue
        end = at + len(name)
        joined.add("_".join((*name, "")), min(words.confidences[at:end]))
        at = end
    return joined


@lru_cache(maxsize=64)
def _by_first_word(fixes: tuple[str, ...]) -> Names:
    names: dict[str, list[tuple[str, ...]]] = {}
    for fix in fixes:
        words = tuple(tokens(fix))
        if words:
            names.setdefault(words[0], []).append(words)
    return {word: tuple(sorted(each, key=len, reverse=True)) for word, each in names.items()}
