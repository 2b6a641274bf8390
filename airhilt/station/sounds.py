"""The sounds of a recorded run: of each frequency, of receivers of seats, and of advisories."""

from __future__ import annotations

import tempfile
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.audio.wav import write_wav_pieces
from airhilt.errors import StationError
from airhilt.messages import AdvisoryAudio, SeatAudioClosed
from airhilt.record import Run
from airhilt.report.frequency import SplicedSound, read_frequency, splice
from airhilt.units import SECOND_NS

ASSISTANT = "assistant"
"""Name of the sound of the spoken advisories."""


class Sounds:
    """Makes each sound of a run when it is asked for, in a folder of its own.

    The run folder is not written to.

    Parameters
    ----------
    frequencies_khz
        Frequencies on which there is sound.
    spoken
        Advisories that were spoken.
    at_seats
        What receivers of seats gave out, by frequency and seat.
    """

    def __init__(
        self,
        run: Run,
        frequencies_khz: Sequence[int],
        spoken: Sequence[AdvisoryAudio],
        at_seats: Mapping[str, Sequence[SeatAudioClosed]],
    ) -> None:
        self._run = run
        self._frequencies_khz = tuple(frequencies_khz)
        self._spoken = tuple({(one.id, one.text): one for one in reversed(spoken)}.values())[::-1]
        self._at_seats = at_seats
        self._folder = tempfile.TemporaryDirectory(prefix="airhilt-", ignore_cleanup_errors=True)
        self._lock = threading.Lock()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the sounds: frequencies in kHz, those at seats, and `ASSISTANT` if it spoke."""
        has_voice = any(one.samples for one in self._spoken)
        voice = (ASSISTANT,) if has_voice else ()
        return (*map(str, self._frequencies_khz), *self._at_seats, *voice)

    def wav(self, name: str) -> Path:
        """Return the WAV file of a sound, which begins with the run.

        Raises
        ------
        AirhiltError
            There is no such sound, or a file of the run is missing or damaged.
        """
        if name not in self.names:
            expected = ", ".join(self.names) or "none: the run has no sound"
            raise StationError(f"sound {name!r}: not in this run; expected {expected}")
        path = Path(self._folder.name) / f"{name}.wav"
        with self._lock:
            if not path.is_file():
                write_wav_pieces(path, self._sound(name).pieces())
        return path

    def _sound(self, name: str) -> SplicedSound:
        if name in self._at_seats:
            in_order = sorted(self._at_seats[name], key=lambda one: (one.t_tx_ns, one.id))
            return splice(self._run.paths, ((one.t_tx_ns, one.t_end_ns, one) for one in in_order))
        if name != ASSISTANT:
            return read_frequency(self._run, int(name)).sound
        heard = ((one.t_ns, _end_ns(one), one) for one in self._spoken)
        return splice(self._run.paths, heard)

    def close(self) -> None:
        """Delete the files."""
        self._folder.cleanup()


def _end_ns(audio: AdvisoryAudio) -> int:
    return audio.t_ns + audio.samples * SECOND_NS // SAMPLE_RATE_HZ
