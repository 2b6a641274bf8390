"""The debrief of a recorded run: all that its page shows, read once."""

from __future__ import annotations

from typing import Any

from airhilt.errors import StationError
from airhilt.host.text import readable
from airhilt.record import Run
from airhilt.record.kept_pictures import kept_pictures
from airhilt.report.data import read_run
from airhilt.report.sections import GuardedContent, Section
from airhilt.station.cameras import CameraRecord
from airhilt.station.recorded import KEYS, RecordedMessages
from airhilt.station.redrawing import RedrawnPictures
from airhilt.station.sounds import Sounds

Json = dict[str, Any]
SHARED = (
    "run", "scenario", "phase", "cause", "separation", "pair", "end_s", "tracks", "airport",
    "events", "summary",
)  # fmt: skip
"""Parts of `airhilt.report.data.RunData.as_json` that the page shows, as a report does."""
OWN = ("calls", "spoken", "advisories", "cameras", "latencies")
"""Parts that `RecordedMessages` gives."""


class Debrief:
    """Content of the page of a run folder.

    Parameters
    ----------
    run
        The run, opened with `airhilt.open_run`.

    Attributes
    ----------
    document
        Document with which the page begins, for JSON.
    sounds
        Sounds of the frequencies, of receivers of seats, and of the assistant.
    """

    def __init__(self, run: Run) -> None:
        log = RecordedMessages(run.paths)
        section = Section("debrief", order=0, module=__file__, content=lambda _: log, keys=KEYS)
        content = GuardedContent(section, run.paths)
        data = read_run(run, run.paths.report_path, [content])
        own = content.as_json(data) or dict.fromkeys(OWN, ())
        self._locate, self._cameras = data.locate, log.cameras
        self.sounds = Sounds(run, log.frequencies_khz, log.spoken, log.heard_at_seats)
        self._kept, damaged = kept_pictures(run)
        self._redrawn = RedrawnPictures(run.info, log.states)
        shared = data.as_json()
        self.document: Json = {
            **{name: shared[name] for name in SHARED},
            **own,
            "notes": [*shared["notes"], *map(readable, content.notes), *damaged],
            "folder": str(run.folder),
            "sounds": self.sounds.names,
        }

    def camera(self, name: str) -> Json:
        """Return the pictures of a camera with their boxes, and the numbers of those kept.

        Raises
        ------
        StationError
            There is no such camera.
        """
        record = self._camera(name)
        kept = [seq for seq in sorted(record.exposures) if (name, seq) in self._kept]
        return {**record.as_json(self._locate), "kept": kept}

    def picture(self, name: str, seq: int) -> bytes:
        """Return a picture of a camera as JPEG: as it was if the run has kept it, else drawn again.

        Raises
        ------
        AirhiltError
            There is no such picture, or it cannot be drawn here.
        """
        t_ns = self._camera(name).exposures.get(seq)
        if t_ns is None:
            raise StationError(f"camera {name!r}: no picture {seq} in this run")
        return self._kept.get((name, seq)) or self._redrawn.jpeg(name, t_ns)

    def _camera(self, name: str) -> CameraRecord:
        record = self._cameras.get(name)
        if record is None:
            known = ", ".join(self._cameras) or "none: the run has no pictures"
            raise StationError(f"camera {readable(name)!r}: not in this run; expected {known}")
        return record

    def close(self) -> None:
        """End what draws, and delete the sounds."""
        self._redrawn.close()
        self.sounds.close()
