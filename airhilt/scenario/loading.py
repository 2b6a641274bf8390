"""Reading scenario files, with the files that they name: airports, types of aircraft, channels.

JSON files become part of the scenario, so that a run, its replay and its report need nothing else.
Every error names the file, the JSON path, and what was expected.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.scenario import documents, radio_profiles
from airhilt.scenario.documents import Json
from airhilt.scenario.models import Scenario
from airhilt.scenario.problems import Problem, error_for, validated


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
    return validated(Scenario, _with_files(document, path, allowed), str(path))


def parse(text: str, origin: str) -> Scenario:
    """Return the scenario in a JSON text, not checked against the world.

    Raises
    ------
    ScenarioError
        The text is not JSON, or does not follow the schema.
    """
    return validated(Scenario, documents.parse(text, origin), origin)


def _with_files(document: Json, path: Path, allowed: Sequence[Path]) -> Json:
    """Return the document of a scenario with the JSON files that it names, as ``files``.

    The path of a learned radio channel becomes one from the current folder.
    """
    if not isinstance(document, dict):
        return document
    folders = [folder.resolve() for folder in (path.parent, *allowed)]
    given = document.get("files", {})
    read: dict[str, Json] = {}
    for where, name in _named(document):
        if name not in read and isinstance(given, dict) and name not in given:
            file = _found(path, where, name, folders)
            read[name] = documents.read(file)
    if read and isinstance(given, dict):
        document = document | {"files": given | read}
    radio = document.get("radio")
    profile = radio.get("profile") if isinstance(radio, dict) else None
    if isinstance(profile, str) and radio_profiles.is_learned(profile):
        file = _found(path, "radio/profile", profile, folders)
        document = document | {"radio": radio | {"profile": str(file)}}
    return document


def _named(document: dict[str, Json]) -> Iterator[tuple[str, str]]:
    """Yield place and name of each JSON file that a document names."""
    scene, actors = document.get("scene"), document.get("actors")
    places = [("scene/airport", scene.get("airport"))] if isinstance(scene, dict) else []
    for index, actor in enumerate(actors if isinstance(actors, list) else ()):
        if isinstance(actor, dict):
            places.append((f"actors/{index}/aircraft", actor.get("aircraft")))
    yield from (
        (at, name) for at, name in places if isinstance(name, str) and name.endswith(".json")
    )


def _found(path: Path, where: str, name: str, folders: Sequence[Path]) -> Path:
    """Return the path of a file that a scenario names."""
    file = path.parent / name
    resolved = file.resolve()
    if not any(resolved.is_relative_to(folder) for folder in folders):
        text = (
            f"found {name!r}, which is not in the folder of the scenario; give its folder with "
            "--allow-path"
        )
    elif not resolved.is_file():
        text = f"found {name!r}, but there is no file {str(file)!r}; names are relative to {path}"
    else:
        return file
    raise error_for(str(path), [Problem(where, text)])
