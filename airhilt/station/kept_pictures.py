"""The pictures of cameras that a run has kept in its folder."""

from __future__ import annotations

import io
from itertools import islice

from PIL import Image

from airhilt.record import Run
from airhilt.record.pictures import PictureName
from airhilt.record.run import result_problem
from airhilt.station.pictures import encoded
from airhilt.text import readable

MOST = 12
"""Number of pictures that are read; a run keeps three of full size."""
DAMAGED = (OSError, SyntaxError, ValueError, Image.DecompressionBombError)
"""Exceptions of Pillow where a file is no picture."""


class KeptPictures:
    """The key pictures of a run that have their full size, each as JPEG.

    Parameters
    ----------
    run
        The run; its folder is read at once.

    Attributes
    ----------
    notes
        A line for each picture that is damaged, or not one that the run wrote.
    """

    def __init__(self, run: Run) -> None:
        self.notes: list[str] = []
        self._jpegs: dict[tuple[str, int], bytes] = {}
        named = map(PictureName.of, sorted(run.folder.pictures_path.glob("*.png")))
        for name in islice(filter(None, named), MOST):
            path = name.path(run.folder.pictures_path)
            try:
                with run.folder.open_file(path) as stream:
                    problem = result_problem(run.folder, run.info, path)
                    content = b"" if problem else stream.read()
            except OSError as error:
                problem = f"pictures/{path.name}: {error.strerror}"
            if not problem:
                try:
                    self._jpegs[name.camera, name.seq] = _as_jpeg(content)
                except DAMAGED:
                    problem = f"pictures/{path.name}: cannot be read as a picture"
            if problem:
                self.notes.append(f"Damaged: {readable(problem)}. It is not used.")

    def has(self, camera: str, seq: int) -> bool:
        """Return true if a picture was kept."""
        return (camera, seq) in self._jpegs

    def jpeg(self, camera: str, seq: int) -> bytes | None:
        """Return a picture, None if it was not kept."""
        return self._jpegs.get((camera, seq))


def _as_jpeg(content: bytes) -> bytes:
    return encoded(Image.open(io.BytesIO(content), formats=["PNG"]).convert("RGB"))
