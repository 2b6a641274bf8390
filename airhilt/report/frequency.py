"""Writes the sound of one frequency of a run, and its transcript beside it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import dataclass, field, replace
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
from airhilt.messages import Transmission
from airhilt.metrics.calls import CallRecord, CallRecords
from airhilt.quantities import LONGEST_RUN_S
from airhilt.record import Run, RunFolder, open_run
from airhilt.record.audio import MessageWithSound, audio_file, recorded_pcm
from airhilt.record.damage import Notice, untold
from airhilt.units import SECOND_NS

Json = dict[str, Any]

SILENCE_SAMPLES = 10 * SAMPLE_RATE_HZ
"""Greatest number of samples of silence in a piece of sound."""
LATEST_NS = round((LONGEST_RUN_S + 60.0) * SECOND_NS)
"""Latest time of what was said in a run, in ns: a call may last beyond its end."""


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

        It raises `RunFolderError` if a sound file is missing, or not what was received.
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
    calls: list[Json]
    """The calls as they were said and recognised, with times in s."""
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

    def as_dict(self) -> Json:
        """Return everything but the sound, for JSON."""
        return {
            "run": self.run,
            "frequency_khz": self.frequency_khz,
            "duration_s": self.duration_s,
            "calls": self.calls,
            "notes": list(self.notes),
        }


def write_frequencies(
    run_folder: Path,
    frequency_khz: int | None = None,
    out: Path | None = None,
    notice: Notice = untold,
) -> list[tuple[FrequencyRecording, Path, Path]]:
    """Write the sound of frequencies with the timing of the run, and transcripts beside it.

    Without a frequency it takes all of the run; without a WAV file it writes into the run folder,
    under the name of the frequency. The notice is told what is damaged; the transcript says it too.
    Each recording is returned with the WAV file and the transcript's file.

    It raises `RunFolderError` if there is no run, nothing was said there, a sound file is not what
    was received, or one file is given for several frequencies, and `SpeechError` if the run has no
    sound.
    """
    run = open_run(run_folder, notice)
    received = _received(run)
    chosen = _chosen(run.paths, {tx.frequency_khz for _, tx in received}, frequency_khz)
    if out is not None and len(chosen) > 1:
        raise RunFolderError(
            f"{out}: one file for several frequencies; choose one with --frequency: "
            f"{', '.join(map(str, chosen))} (kHz)"
        )
    return [_written(run, _recording(run, received, each), out) for each in chosen]


def _written(
    run: Run, recording: FrequencyRecording, out: Path | None
) -> tuple[FrequencyRecording, Path, Path]:
    wav = out or run.folder / f"frequency-{recording.frequency_khz}.wav"
    if wav.suffix.lower() != ".wav":
        raise SpeechError(f"{wav}: cannot be written; expected a name that ends with .wav")
    return recording, wav, write_recording(recording, wav)


def write_recording(recording: FrequencyRecording, wav: Path) -> Path:
    """Write the sound of a frequency, and its transcript beside it, whose path is returned.

    It raises what `write_frequencies` does.
    """
    text = wav.with_suffix(".txt")
    write_wav_pieces(wav, recording.sound.pieces())
    try:
        replace_file(text, recording.text().encode())
    except OSError as error:
        raise SpeechError(f"{text}: cannot be written: {error.strerror}") from None
    return text


def read_frequency(run: Run, frequency_khz: int) -> FrequencyRecording:
    """Return the sound of a frequency, and what was said on it; else as `write_frequencies`."""
    received = _received(run)
    _chosen(run.paths, {tx.frequency_khz for _, tx in received}, frequency_khz)
    return _recording(run, received, frequency_khz)


def read_frequencies(run: Run) -> Iterator[FrequencyRecording]:
    """Yield the recordings of all frequencies on which there was sound; else as `read_frequency`.

    Nothing is yielded of a run without speech.
    """
    received = _received(run)
    with_sound = [tx for _, tx in received if tx.samples]
    for frequency_khz in sorted({tx.frequency_khz for tx in with_sound}):
        yield _recording(run, received, frequency_khz)


def _received(run: Run) -> list[tuple[CallRecord, Transmission]]:
    """Return the calls of a run that were received, each as it was."""
    records = CallRecords()
    try:
        for logged in run.log():
            records.read(logged.key, logged.data)
    except ValidationError as error:
        raise RunFolderError(
            f"{run.paths.log_path}: {first_problem(error)}; expected a log of this version of "
            "AIRHILT"
        ) from None
    return [(call, tx) for call in records if (tx := call.received) is not None]


def _recording(
    run: Run, received: Sequence[tuple[CallRecord, Transmission]], frequency_khz: int
) -> FrequencyRecording:
    tuned = [(call, tx) for call, tx in received if tx.frequency_khz == frequency_khz]
    tuned.sort(key=lambda one: (one[1].t_tx_ns, one[1].id))
    sound = splice(run.paths, ((tx.t_tx_ns, tx.t_end_ns, tx) for _, tx in tuned))
    calls = [_call(call, tx) for call, tx in tuned]
    return FrequencyRecording(run.info.run, frequency_khz, calls, sound, run.damage)


def _chosen(folder: RunFolder, used: Set[int], frequency_khz: int | None) -> list[int]:
    """Return the frequency that is asked for, or all that were used."""
    if not used:
        raise RunFolderError(f"{folder.path}: nobody said anything in this run")
    if frequency_khz is None:
        return sorted(used)
    if frequency_khz not in used:
        raise RunFolderError(
            f"{folder.path}: nobody said anything on {frequency_khz} kHz; expected one of "
            f"{', '.join(map(str, sorted(used)))}"
        )
    return [frequency_khz]


def _call(call: CallRecord, tx: Transmission) -> Json:
    said = call.said
    return {
        "id": tx.id,
        "t_tx_s": tx.t_tx_ns / SECOND_NS,
        "t_end_s": tx.t_end_ns / SECOND_NS,
        "snr_db": tx.snr_db,
        "speaker": said.speaker if said else "",
        "addressed": said.addressed if said else None,
        "said": said.text if said else "",
        "blocked_by": said.blocked_by if said else (),
        "heard": [
            {
                "text": transcript.text,
                "confidence": transcript.confidence,
                "engine": transcript.engine,
                "after_end_s": (transcript.t_ns - tx.t_end_ns) / SECOND_NS,
            }
            for transcript in call.transcripts
        ],
    }


def splice(folder: RunFolder, heard: Iterable[tuple[int, int, MessageWithSound]]) -> SplicedSound:
    """Return the sound of messages from the start of the run, each at its time in ns.

    Two transmissions that blocked each other were both received mixed: the second is taken from
    where the first ends. A call that begins during the squelch tail of the one before cuts it off.
    Begins of messages rise. It raises `RunFolderError` for a message at a time that no run has, and
    `SpeechError` if none has sound.
    """
    placed: list[_Placed] = []
    free_at = 0
    for begin_ns, end_ns, message in heard:
        if not 0 <= begin_ns <= end_ns <= LATEST_NS:
            raise RunFolderError(
                f"{folder.log_path}: {readable(message.id)} has times that no run has; expected a "
                f"beginning and an end within {LONGEST_RUN_S:.0f} s"
            )
        if message.samples == 0:
            continue
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


def _paragraph(call: Json) -> str:
    minutes, rest = divmod(call["t_tx_s"], 60.0)
    notes = [f"{call['t_end_s'] - call['t_tx_s']:.1f} s"]
    if call["snr_db"] is not None:
        notes.append(f"{call['snr_db']:.0f} dB")
    if call["blocked_by"]:
        notes.append(f"blocked by {', '.join(call['blocked_by'])}")
    to = f" to {call['addressed']}" if call["addressed"] else ""
    lines = [
        f"{int(minutes):02d}:{rest:04.1f}  {call['speaker'] or 'somebody'}{to}  "
        f"[{call['id']}: {', '.join(notes)}]",
        f"         said   {call['said'] or '(nothing)'}",
    ]
    for one in call["heard"]:
        lines.append(
            f"         heard  {one['text'] or '(nothing)'}  [{one['engine']}, confidence "
            f"{one['confidence']:.2f}, {one['after_end_s']:.2f} s after the call]"
        )
    return "\n".join(lines)
