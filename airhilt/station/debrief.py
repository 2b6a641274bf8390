"""The debrief of a recorded run: all that its page shows, read once."""

from __future__ import annotations

from typing import Any

from airhilt.errors import StationError
from airhilt.host.text import readable
from airhilt.record import Run
from airhilt.report.data import read_run
from airhilt.report.sections import Content, GuardedContent, Section
from airhilt.station import advisories, calls, cameras, latencies, redrawing, seat_sounds
from airhilt.station.kept_pictures import kept_pictures
from airhilt.station.sounds import Sounds

Json = dict[str, Any]
SHARED = (
    "run", "scenario", "phase", "cause", "separation", "pair", "end_s", "tracks", "airport",
    "events", "summary",
)  # fmt: skip
"""Parts of `airhilt.report.data.RunData.as_json` that the page shows, as a report does."""


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
        folder = run.folder
        said, advised = calls.Calls(folder), advisories.Advisories(folder)
        at_seats = seat_sounds.SeatSounds(folder)
        self._cameras, states = cameras.Cameras(folder), redrawing.States(folder)
        contents = [
            _content("calls", said, calls.KEYS),
            _content("seat_sounds", at_seats, seat_sounds.KEYS),
            _content("advisories", advised, advisories.KEYS),
            _content("cameras", self._cameras, cameras.KEYS),
            _content("states", states, redrawing.KEYS),
            _content("latencies", latencies.Latencies(folder), latencies.KEYS),
        ]
        data = read_run(run, folder.report_path, contents)
        self._locate = data.locate
        parts = {content.section.name: content.as_json(data) for content in contents}
        notes = [readable(note) for content in contents for note in content.notes]
        self.sounds = Sounds(run, said.frequencies_khz, said.spoken, at_seats.heard)
        self._kept, damaged = kept_pictures(run)
        self._redrawn = redrawing.RedrawnPictures(run.info, states.by_actor())
        shared = data.as_json()
        self.document: Json = {
            **{name: shared[name] for name in SHARED},
            "notes": [*shared["notes"], *notes, *damaged],
            "folder": str(folder.path),
            "calls": (parts["calls"] or {}).get("calls", []),
            "spoken": (parts["calls"] or {}).get("spoken", []),
            "advisories": parts["advisories"] or [],
            "cameras": parts["cameras"] or [],
            "latencies": parts["latencies"] or [],
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

    def _camera(self, name: str) -> cameras.CameraRecord:
        record = self._cameras.records.get(name)
        if record is None:
            known = ", ".join(self._cameras.records) or "none: the run has no pictures"
            raise StationError(f"camera {readable(name)!r}: not in this run; expected {known}")
        return record

    def close(self) -> None:
        """End what draws, and delete the sounds."""
        self._redrawn.close()
        self.sounds.close()


def _content(name: str, content: Content, keys: tuple[str, ...]) -> GuardedContent:
    section = Section(name, order=0, module=__file__, content=lambda _: content, keys=keys)
    return GuardedContent(section, content.folder)
