"""What a section of the page rests on, as its folder has it: numbers, and the code they are of."""

from __future__ import annotations

import json
import subprocess
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from airhilt.errors import AirhiltError
from airhilt.host.files import make_folder, replace_file
from airhilt.sweep.evaluation.tables import Table

ROOT = Path(__file__).resolve().parents[2]
INPUTS = (
    "airhilt",
    "scenarios",
    "aircraft",
    "airports",
    "tools/judge_encounters.py",
    "tools/pairs",
    "tools/benchmarks",
)
"""Files that the numbers depend on."""
EVALUATION = "evaluation.json"
CODE = "code.json"


@dataclass(frozen=True)
class Code:
    """State of `INPUTS`: the last commit that changed them.

    Attributes
    ----------
    is_dirty
        True if there were changes that were not committed.
    made
        Time at which the numbers were complete, UTC; empty as long as they are not.
    """

    commit: str
    is_dirty: bool
    made: str = ""


@dataclass(frozen=True)
class Record:
    """The numbers of a section: ``evaluation.json``, and the code that they are of."""

    code: Code
    document: dict[str, Any]

    @property
    def tables(self) -> dict[str, Table]:
        """The tables by name."""
        return {each["name"]: Table.model_validate(each) for each in self.document["tables"]}

    @property
    def facts(self) -> dict[str, str]:
        """Single numbers and words by name.

        An evaluation has its runs, its cameras (yes or no), and the command that makes it besides.
        """
        own = self.document
        found = {name: str(value) for name, value in own.items() if isinstance(value, int | str)}
        if "preset" in own:
            has_cameras = own["options"].get("cameras", True)
            found["cameras"] = "yes" if has_cameras else "no"
            found["runs"] = str(sum(each["runs"] for each in own["sweeps"].values()))
            found["command"] = (
                f"airhilt evaluate --preset {own['preset']} --seeds {own['seeds']}"
                f"{'' if has_cameras else ' --no-cameras'}"
            )
        return found


def current_code(allows_dirty: bool) -> Code:
    """Return the state of `INPUTS` in this tree.

    Raises
    ------
    AirhiltError
        There are changes that are not committed, and they are not allowed.
    """
    changed = _git("status", "--porcelain", "--", *INPUTS).splitlines()
    if changed and not allows_dirty:
        others = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        raise AirhiltError(
            f"{changed[0][3:]}{others}: not committed, and the page names one commit for all of "
            "its numbers; commit them, or give --dirty"
        )
    return Code(_git("log", "-1", "--format=%H", "--", *INPUTS).strip(), bool(changed))


def write_document(folder: Path, document: dict[str, Any]) -> None:
    """Write the ``evaluation.json`` of a section that is not made by `airhilt evaluate`."""
    make_folder(folder)
    replace_file(folder / EVALUATION, f"{json.dumps(document, indent=2)}\n".encode())


def write_code(folder: Path, code: Code) -> None:
    """Write of which code the numbers in a folder are."""
    made = datetime.now(UTC).isoformat(timespec="seconds")
    record = asdict(code) | {"made": made}
    replace_file(folder / CODE, f"{json.dumps(record, indent=2)}\n".encode())


def read(folder: Path) -> Record | None:
    """Return the record of a section; None if its runs have not been completed."""
    if not (folder / CODE).exists():
        return None
    code = Code(**json.loads((folder / CODE).read_text(encoding="utf-8")))
    return Record(code, json.loads((folder / EVALUATION).read_text(encoding="utf-8")))


def _git(*words: str) -> str:
    return subprocess.run(
        ["git", *words], cwd=ROOT, capture_output=True, check=True, text=True
    ).stdout
