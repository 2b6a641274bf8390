"""Reading scenario files; every error names the file, the JSON path, and what was expected."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pydantic import ValidationError

from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.scenario import documents
from airhilt.scenario.models import Scenario
from airhilt.scenario.nearby import with_nearby_files
from airhilt.scenario.problems import error_for, problems_of


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


def read(path: Path, allowed: Sequence[Path] = ()) -> Scenario:
    """Return the scenario in a file, with the files that it names, not checked against the world.

    Parameters
    ----------
    allowed
        Folders besides its own in which it may name files.

    Raises
    ------
    ScenarioError
        A file cannot be read, or does not follow the schema.
    """
    document = documents.read(path)
    return _validated(with_nearby_files(document, path, allowed), str(path))


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
    return _validated(documents.parse(text, origin), origin)


def _validated(document: documents.Json, origin: str) -> Scenario:
    try:
        return Scenario.model_validate(document)
    except ValidationError as error:
        raise error_for(origin, problems_of(error, Scenario)) from None
