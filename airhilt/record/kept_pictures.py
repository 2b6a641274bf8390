"""Pictures that a run has kept, as JPEG."""

from __future__ import annotations

import io
from pathlib import Path

from PIL import Image

from airhilt.host.files import read_inside
from airhilt.host.text import readable
from airhilt.record.pictures import PictureName
from airhilt.record.run import Run, result_problem

QUALITY = 85
"""Quality of the JPEG pictures, of at most 95 (Pillow)."""
MOST_KEPT = 12
"""Number of pictures that are read; a run keeps three of full size."""
MOST_BYTES = 50_000_000
"""Size of the largest file that is read."""
NO_PICTURE = "cannot be read as a picture"
Pictures = dict[tuple[str, int], bytes]
"""Pictures as JPEG, by the name of the camera and the number of the picture."""


def encoded(image: Image.Image) -> bytes:
    """Return an image as JPEG."""
    stream = io.BytesIO()
    image.save(stream, "JPEG", quality=QUALITY)
    return stream.getvalue()


def kept_pictures(run: Run) -> tuple[Pictures, list[str]]:
    """Return the key pictures of a run that have their full size.

    Returns
    -------
    pictures
        The pictures.
    notes
        A line for each picture that is damaged, or not one that the run wrote.
    """
    found: Pictures = {}
    notes = []
    for path, name in _named(run)[:MOST_KEPT]:
        problem = result_problem(run.paths, run.info, path)
        if not problem:
            try:
                content = read_inside(run.folder, path, MOST_BYTES)
                image = Image.open(io.BytesIO(content), formats=["PNG"])
                found[name.camera, name.seq] = encoded(image.convert("RGB"))
            except OSError as error:
                problem = f"pictures/{path.name}: {error.strerror or NO_PICTURE}"
            except Exception:  # Pillow ends a damaged file with any exception.
                problem = f"pictures/{path.name}: {NO_PICTURE}"
        if problem:
            notes.append(f"Damaged: {readable(problem)}. It is not used.")
    return found, notes


def _named(run: Run) -> list[tuple[Path, PictureName]]:
    """Return the pictures of full size in the folder of a run, those with a record first."""
    folder = run.paths.pictures_path
    names = {path: PictureName.of(path) for path in sorted(folder.glob("*.png"))}
    found = [(path, name) for path, name in names.items() if name and name.path(folder) == path]
    return sorted(found, key=lambda one: f"pictures/{one[0].name}" not in run.info.files)
