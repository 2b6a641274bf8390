"""Reading scenario files; every error names the file, the JSON path, and what was expected."""

from __future__ import annotations

import json
from pathlib import Path

from pydantic import ValidationError

from airhilt import library
from airhilt.errors import ScenarioError
from airhilt.scenario.models import Scenario
from airhilt.scenario.problems import error_for, problems_of

MAXIMUM_BYTES = 20_000_000
"""Size of the largest file that is read."""


def find(name_or_file: str | Path) -> Path:
    """Return the path of a scenario file, or of a scenario that ships with AIRHILT, by name.

    Raises
    ------
    ScenarioError
        There is none; the message gives the nearest name.
    """
    path = Path(name_or_file)
    if path.suffix == ".json" or len(path.parts) > 1 or path.is_file():
        if not path.is_file():
            raise ScenarioError(
                f"{path}: no such file; give the path of a scenario file, or one of these names: "
                f"{', '.join(library.names('scenarios'))}"
            )
        return path
    return library.find("scenarios", str(name_or_file))


def read(path: Path) -> Scenario:
    """Return the scenario in a file, not checked against the world.

    Raises
    ------
    ScenarioError
        The file cannot be read, or does not follow the schema.
    """
    try:
        if path.stat().st_size > MAXIMUM_BYTES:
            raise ScenarioError(f"{path}: over {MAXIMUM_BYTES // 1_000_000} MB, no scenario is")
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ScenarioError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ScenarioError(f"{path}: not UTF-8 text (byte {error.start})") from None
    return parse(text, str(path))


def parse(text: str, origin: str) -> Scenario:
    """Return the scenario in a JSON text, not checked against the world.

    Parameters
    ----------
    origin
        Name of the text in errors.

    Raises
    ------
    ScenarioError
        The text is not JSON, or does not follow the schema.
    """
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        raise ScenarioError(
            f"{origin}:{error.lineno}:{error.colno}: not valid JSON: {error.msg}"
        ) from None
    except ValueError:
        raise ScenarioError(
            f"{origin}: an integer of thousands of digits, no scenario has"
        ) from None
    except RecursionError:
        raise ScenarioError(f"{origin}: nested too deeply") from None
    try:
        return Scenario.model_validate(document)
    except ValidationError as error:
        raise error_for(origin, problems_of(error, Scenario)) from None
