"""Files beside a scenario: an airport, types of aircraft, a learned radio channel.

JSON files become part of the scenario, so that a run, its replay and its report need nothing else.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from airhilt.scenario import documents, radio_profiles
from airhilt.scenario.documents import Json
from airhilt.scenario.problems import Problem, error_for

SUFFIX = ".json"
"""End of the name of a file beside the scenario, in the place of a name that AIRHILT knows."""


def with_nearby_files(document: Json, path: Path, allowed: Sequence[Path] = ()) -> Json:
    """Return the document of a scenario with the files that it names, as its field ``files``.

    The path of a learned radio channel becomes one from the current folder.

    Parameters
    ----------
    path
        File of the scenario; names are relative to its folder.
    allowed
        Folders besides that one in which files may be.

    Raises
    ------
    ScenarioError
        A file is not there, is no JSON, or lies elsewhere.
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
    yield from ((at, name) for at, name in places if isinstance(name, str) and is_file(name))


def is_file(name: str) -> bool:
    """Return whether the name of an airport or a type is that of a file."""
    return name.endswith(SUFFIX)


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
