"""Writes the sound of one frequency of a run, and its transcript beside it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio, from_pcm
from airhilt.audio.wav import write_wav_pieces
from airhilt.errors import RunFolderError, SpeechError, first_problem
from airhilt.host.files import replace_file
from airhilt.host.text import LONGEST_LINE, readable
from airhilt.messages import SpokenTruth, Transcript, Transmission
from airhilt.quantities import LONGEST_RUN_S
from airhilt.record.audio import MessageWithSound, audio_file, recorded_pcm
from airhilt.record.damage import Notice, untold
from airhilt.record.folder import RunFolder
from airhilt.record.run import Run, open_run
from airhilt.units import SECOND_NS

SILENCE_SAMPLES = 10 * SAMPLE_RATE_HZ
"""Greatest number of samples of silence in a piece of sound."""
LATEST_NS = round((LONGEST_RUN_S + 60.0) * SECOND_NS)
"""Latest time of what was said in a run, in ns: a call may last beyond its end."""


@dataclass(frozen=True, slots=True)
class Recognition:
    """One recogniser's transcript of a call."""

    text: str
    confidence: float
    engine: str
    after_end_s: float
    """Time from the end of the call to its transcript, in s."""


@dataclass(frozen=True, slots=True)
class RecordedCall:
    """One transmission on the frequency, as it was said and recognised."""

    id: str
    t_tx_s: float
    t_end_s: float
    snr_db: float | None
    speaker: str
    addressed: str | None
    said: str
    blocked_by: tuple[str, ...]
    heard: tuple[Recognition, ...]


@dataclass(frozen=True, slots=True)
class _Placed:
    """A message, and which samples of the run are of it."""

    message: MessageWithSound
    begin: int
    end: int
    skipped: int
    """Number of its own samples that are left out at its beginning."""


@dataclass(frozen=True)
class SplicedSound:
    """The sound of messages, each at its time in the run, with silence between them."""

    folder: RunFolder
    placed: tuple[_Placed, ...]

    @property
    def samples(self) -> int:
        """Number of samples from the start of the run to the end of the last message."""
        return self.placed[-1].end

    def pieces(self) -> Iterator[Audio]:
        """Yield the sound by pieces, so that no day of silence is ever in memory.

        Raises
        ------
        RunFolderError
            A sound file is missing, or not what was received.
        """
        at = 0
        for one in self.placed:
            for begin in range(at, one.begin, SILENCE_SAMPLES):
                yield np.zeros(min(one.begin - begin, SILENCE_SAMPLES), np.float32)
            received = from_pcm(recorded_pcm(self.folder.audio_path, one.message))
            if len(received) != one.message.samples:
                raise RunFolderError(
                    f"{audio_file(self.folder.audio_path, one.message)}: {len(received)} samples; "
                    f"expected {one.message.samples}, as the log says"
                )
            yield received[one.skipped : one.skipped + one.end - one.begin]
            at = one.end


@dataclass(frozen=True)
class FrequencyRecording:
    """The calls and the sound of one frequency, from the start of the run to its last call."""

    run: str
    frequency_khz: int
    calls: tuple[RecordedCall, ...]
    sound: SplicedSound = field(repr=False)
    notes: tuple[str, ...] = ()
    """Files of the run that are damaged."""

    @property
    def duration_s(self) -> float:
        """Length of the sound, in s."""
        return self.sound.samples / SAMPLE_RATE_HZ

    def text(self) -> str:
        """Return the transcript for people to read."""
        head = f"{self.run}, {self.frequency_khz / 1000:.3f} MHz, {len(self.calls)} calls"
        notes = (f"Damaged: {note}" for note in self.notes)
        lines = "\n\n".join([head, *notes, *map(_paragraph, self.calls)]).split("\n")
        return "".join(f"{readable(line, LONGEST_LINE)}\n" for line in lines)

    def as_dict(self) -> dict[str, Any]:
        """Return everything but the sound, for JSON."""
        return {
            "run": self.run,
            "frequency_khz": self.frequency_khz,
            "duration_s": self.duration_s,
            "calls": [asdict(call) for call in self.calls],
            "notes": list(self.notes),
        }


def write_frequency(
    run_folder: Path,
    frequency_khz: int | None = None,
    out: Path | None = None,
    notice: Notice = untold,
) -> tuple[FrequencyRecording, Path, Path]:
    """Write the sound of a frequency with the timing of the run, and its transcript.

    Parameters
    ----------
    frequency_khz
        The frequency; None takes the only one of the run.
    out
        The WAV file; the transcript has the same name with ``.txt``. None writes both into the
        run folder, under the name of the frequency.
    notice
        Is told what is damaged; the transcript says it too.

    Returns
    -------
    tuple
        The recording, the WAV file and the transcript's file.

    Raises
    ------
    RunFolderError
        There is no run, nothing was said on that frequency, or a sound file is not what was
        received.
    SpeechError
        The run has no sound.
    """
    run = open_run(run_folder, notice)
    recording = read_frequency(run, frequency_khz)
    wav = out or run.folder.path / f"frequency-{recording.frequency_khz}.wav"
    if wav.suffix.lower() != ".wav":
        raise SpeechError(f"{wav}: cannot be written; expected a name that ends with .wav")
    text = wav.with_suffix(".txt")
    write_wav_pieces(wav, recording.sound.pieces())
    try:
        replace_file(text, recording.text().encode())
    except OSError as error:
        raise SpeechError(f"{text}: cannot be written: {error.strerror}") from None
    return recording, wav, text


def read_frequency(run: Run, frequency_khz: int | None = None) -> FrequencyRecording:
    """Return the sound of a frequency with the timing of the run, and what was said on it.

    Parameters
    ----------
    frequency_khz
        The frequency; None takes the only one of the run.

    Raises
    ------
    RunFolderError, SpeechError
        As `write_frequency`.
    """
    folder = run.folder
    transmissions: list[Transmission] = []
    spoken: dict[str, SpokenTruth] = {}
    transcripts: dict[str, list[Transcript]] = {}
    try:
        for logged in run.messages():
            kind = logged.key.split("/")
            if kind[0] == "radio" and kind[-1] == "tx":
                transmissions.append(Transmission.model_validate_json(logged.data))
            elif kind[:2] == ["truth", "radio"]:
                truth = SpokenTruth.model_validate_json(logged.data)
                spoken[truth.id] = truth
            elif kind[0] == "asr" and kind[-1] != "partial":
                transcript = Transcript.model_validate_json(logged.data)
                transcripts.setdefault(transcript.id, []).append(transcript)
    except ValidationError as error:
        raise RunFolderError(
            f"{folder.log_path}: {first_problem(error)}; expected a log of this version of AIRHILT"
        ) from None
    for tx in transmissions:
        for end_ns in (tx.t_end_ns, *(each.t_ns for each in transcripts.get(tx.id, ()))):
            _require_in_run(folder, tx.id, tx.t_tx_ns, end_ns)
    chosen = _choose(folder, transmissions, frequency_khz)
    tuned = sorted(
        (tx for tx in transmissions if tx.frequency_khz == chosen),
        key=lambda tx: (tx.t_tx_ns, tx.id),
    )
    calls = tuple(_call(tx, spoken.get(tx.id), transcripts.get(tx.id, ())) for tx in tuned)
    sound = splice(folder, ((tx.t_tx_ns, tx.t_end_ns, tx) for tx in tuned))
    return FrequencyRecording(run.info.run, chosen, calls, sound, run.damage)


def _require_in_run(folder: RunFolder, name: str, begin_ns: int, end_ns: int) -> None:
    """Complain about a time before the run, or after the longest one that there can be."""
    if not 0 <= begin_ns <= end_ns <= LATEST_NS:
        raise RunFolderError(
            f"{folder.log_path}: {readable(name)} has times that no run has; expected a beginning "
            f"and an end within {LONGEST_RUN_S:.0f} s"
        )


def _choose(
    folder: RunFolder, transmissions: Sequence[Transmission], frequency_khz: int | None
) -> int:
    used = sorted({tx.frequency_khz for tx in transmissions})
    if not used:
        raise RunFolderError(f"{folder.path}: nobody said anything in this run")
    names = ", ".join(map(str, used))
    if frequency_khz is None:
        if len(used) > 1:
            raise RunFolderError(
                f"{folder.path}: calls on several frequencies; choose one with --frequency: "
                f"{names} (kHz)"
            )
        return used[0]
    if frequency_khz not in used:
        raise RunFolderError(
            f"{folder.path}: nobody said anything on {frequency_khz} kHz; expected one of {names}"
        )
    return frequency_khz


def _call(
    tx: Transmission, truth: SpokenTruth | None, transcripts: Sequence[Transcript]
) -> RecordedCall:
    return RecordedCall(
        id=tx.id,
        t_tx_s=tx.t_tx_ns / SECOND_NS,
        t_end_s=tx.t_end_ns / SECOND_NS,
        snr_db=tx.snr_db,
        speaker=truth.speaker if truth else "",
        addressed=truth.addressed if truth else None,
        said=truth.text if truth else "",
        blocked_by=truth.blocked_by if truth else (),
        heard=tuple(
            Recognition(
                transcript.text,
                transcript.confidence,
                transcript.engine,
                (transcript.t_ns - tx.t_end_ns) / SECOND_NS,
            )
            for transcript in transcripts
        ),
    )


def splice(folder: RunFolder, heard: Iterable[tuple[int, int, MessageWithSound]]) -> SplicedSound:
    """Return the sound of messages from the start of the run, each at its time.

    No file is read yet.

    Two transmissions that blocked each other were both received mixed: the second is taken from
    where the first ends. A call that begins during the squelch tail of the one before cuts it off.

    Parameters
    ----------
    heard
        Begin and end of each message in ns, and the message; begins rise.

    Raises
    ------
    RunFolderError
        A message has a time that no run has.
    SpeechError
        None of them has sound.
    """
    placed: list[_Placed] = []
    free_at = 0
    for begin_ns, end_ns, message in heard:
        if message.samples == 0:
            continue
        _require_in_run(folder, message.id, begin_ns, end_ns)
        first = _sample(begin_ns)
        begin, end = max(first, free_at), first + message.samples
        if end > begin:
            placed.append(_Placed(message, begin, end, begin - first))
        free_at = max(_sample(end_ns), free_at)
    if not placed:
        raise SpeechError(
            f"{folder.path}: a run without sound on this frequency; expected one that was made "
            "without --no-speech"
        )
    cut = (replace(one, end=min(one.end, after.begin)) for one, after in pairwise(placed))
    return SplicedSound(folder, (*cut, placed[-1]))


def _sample(t_ns: int) -> int:
    return round(t_ns * SAMPLE_RATE_HZ / SECOND_NS)


def _clock(seconds: float) -> str:
    minutes, rest = divmod(seconds, 60.0)
    return f"{int(minutes):02d}:{rest:04.1f}"


def _paragraph(call: RecordedCall) -> str:
    who = call.speaker or "somebody"
    notes = [f"{call.t_end_s - call.t_tx_s:.1f} s"]
    if call.snr_db is not None:
        notes.append(f"{call.snr_db:.0f} dB")
    if call.blocked_by:
        notes.append(f"blocked by {', '.join(call.blocked_by)}")
    to = f" to {call.addressed}" if call.addressed else ""
    lines = [f"{_clock(call.t_tx_s)}  {who}{to}  [{call.id}: {', '.join(notes)}]"]
    lines.append(f"         said   {call.said or '(nothing)'}")
    for one in call.heard:
        lines.append(
            f"         heard  {one.text or '(nothing)'}  [{one.engine}, confidence "
            f"{one.confidence:.2f}, {one.after_end_s:.2f} s after the call]"
        )
    return "\n".join(lines)
