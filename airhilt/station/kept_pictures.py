"""The pictures of cameras that a run has kept in its folder, as they were."""

from __future__ import annotations

import io

from PIL import Image

from airhilt.record import Run
from airhilt.record.pictures import PictureName
from airhilt.record.run import result_problem
from airhilt.station.pictures import encoded
from airhilt.text import readable


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
        for path in sorted(run.folder.pictures_path.glob("*")):
            name = PictureName.of(path)
            if name is None or name.occasion == "start":  # Those of the start are smaller.
                continue
            try:
                with run.folder.open_file(path) as stream:
                    problem = result_problem(run.folder, run.info, path)
                    if not problem:
                        self._jpegs[name.camera, name.seq] = _as_jpeg(stream.read())
            except (OSError, Image.DecompressionBombError) as error:
                problem = f"{path.name}: {error}"
            if problem:
                self.notes.append(f"Damaged: {readable(problem)}. It is drawn again.")

    def has(self, camera: str, seq: int) -> bool:
        """Return true if a picture was kept."""
        return (camera, seq) in self._jpegs

    def jpeg(self, camera: str, seq: int) -> bytes | None:
        """Return a picture, None if it was not kept."""
        return self._jpegs.get((camera, seq))


def _as_jpeg(content: bytes) -> bytes:
    return encoded(Image.open(io.BytesIO(content)).convert("RGB"))
