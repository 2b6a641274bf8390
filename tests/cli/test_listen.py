"""What `airhilt listen` makes of a run folder."""

from __future__ import annotations

import hashlib
import json
import resource
import tracemalloc
import wave
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from airhilt.audio.pcm import from_pcm, to_pcm
from airhilt.audio.wav import read_wav, write_wav
from airhilt.errors import RunFolderError, SpeechError
from airhilt.messages import Message, SpokenTruth, Transcript, Transmission
from airhilt.options import Options
from airhilt.record import LogWriter, RunFolder, RunInfo
from airhilt.report.frequency import write_frequencies

TOWER_KHZ = 118_300
SECOND = 1_000_000_000


class Recording:
    """A run folder whose log says what the test wants."""

    def __init__(self, path: Path) -> None:
        self.path = path
        (path / "audio").mkdir()
        self._log = LogWriter(path / "log.mcap")

    def call(
        self, name: str, begin_s: float, level: float, seconds: float = 1.0,
        frequency_khz: int = TOWER_KHZ, heard: str | None = None, tail_s: float = 0.0,
        claimed_samples: int | None = None,
        **truth: Any,
    ) -> None:  # fmt: skip
        audio = np.full(round(16_000 * (seconds + tail_s)), level, np.float32)
        write_wav(self.path / "audio" / f"{name}.wav", audio)
        times = {
            "t_tx_ns": round(begin_s * SECOND),
            "t_end_ns": round((begin_s + seconds) * SECOND),
        }
        shared = {"id": name, "frequency_khz": frequency_khz, **times}
        digest = hashlib.sha256(to_pcm(audio)).hexdigest()
        self._write(
            f"radio/{frequency_khz}/tx",
            Transmission(
                **shared, snr_db=12.0, samples=claimed_samples or len(audio), sha256=digest
            ),
        )
        said = {"speaker": "AAL123", "addressed": "TOWER", "text": "Washington Tower, hello."}
        self._write(f"truth/radio/{name}", SpokenTruth(**shared, **(said | truth)))
        if heard is not None:
            t_ns = times["t_end_ns"] + SECOND // 4
            self._write(
                f"asr/{frequency_khz}",
                Transcript(**shared, t_ns=t_ns, text=heard, confidence=0.83, engine="ctc"),
            )

    def silent_call(self, name: str, begin_s: float) -> None:
        times = {"t_tx_ns": round(begin_s * SECOND), "t_end_ns": round((begin_s + 1) * SECOND)}
        self._write(
            f"radio/{TOWER_KHZ}/tx", Transmission(id=name, frequency_khz=TOWER_KHZ, **times)
        )

    def _write(self, key: str, message: Message) -> None:
        self._log.write(key, "run", type(message), 0, message.model_dump_json().encode())

    def close(self) -> Path:
        self._log.close()
        return self.path


@pytest.fixture
def recording(tmp_path: Path) -> Recording:
    path = tmp_path / "run"
    path.mkdir()
    options = Options(assistant="none", latency="fixed", cameras=False)
    RunFolder(path).write_info(
        RunInfo(
            run="incursion-0", options=options, assistant="none", pace="virtual",
            scenario={}, realised={}, draws=[],
            endpoint="", started_at="", versions={}, platform={},
        )
    )  # fmt: skip
    return Recording(path)


def at(audio: np.ndarray, second: float) -> float:
    return round(float(audio[round(second * 16_000)]), 2)


def test_calls_are_heard_at_their_times(recording: Recording, tmp_path: Path) -> None:
    recording.call("1", 0.5, 0.1)
    recording.call("2", 3.0, 0.2)
    [(written, wav, _)] = write_frequencies(recording.close(), out=tmp_path / "tower.wav")
    audio = read_wav(wav)
    assert [at(audio, second) for second in (0.2, 1.0, 2.0, 3.5)] == [0.0, 0.1, 0.0, 0.2]
    assert written.duration_s == pytest.approx(4.0)


def test_calls_that_block_each_other_are_not_heard_twice(
    recording: Recording, tmp_path: Path
) -> None:
    recording.call("1", 0.0, 0.1, seconds=2.0)
    recording.call("2", 1.0, 0.2, seconds=2.0, blocked_by=("1",))
    [(_, wav, text)] = write_frequencies(recording.close(), out=tmp_path / "tower.wav")
    audio = read_wav(wav)
    assert [at(audio, second) for second in (0.5, 1.5, 2.5)] == [0.1, 0.1, 0.2]
    assert "blocked by 1" in text.read_text()


def test_a_call_cuts_off_the_squelch_tail_before_it(recording: Recording, tmp_path: Path) -> None:
    recording.call("1", 0.0, 0.1, tail_s=0.5)
    recording.call("2", 1.2, 0.2)
    [(_, wav, _)] = write_frequencies(recording.close(), out=tmp_path / "tower.wav")
    audio = read_wav(wav)
    assert [at(audio, second) for second in (0.9, 1.1, 1.3)] == [0.1, 0.1, 0.2]


def test_the_transcript_says_who_said_what_and_what_was_heard(
    recording: Recording, tmp_path: Path
) -> None:
    recording.call("r-1", 65.0, 0.1, heard="washington tower yellow")
    [(_, wav, text)] = write_frequencies(recording.close(), out=tmp_path / "tower.wav")
    assert text == wav.with_suffix(".txt")
    written = text.read_text()
    for part in (
        "118.300 MHz", "01:05.0", "AAL123 to TOWER", "r-1", "12 dB", "Washington Tower, hello.",
        "washington tower yellow", "ctc", "0.83", "0.25 s after the call",
    ):  # fmt: skip
        assert part in written


def test_the_transcript_has_no_control_characters(recording: Recording, tmp_path: Path) -> None:
    recording.call("r-1", 1.0, 0.1, heard="\x1b[2J\u202e" + "x" * 5000, speaker="\x9b\nEVIL")
    [(_, _, text)] = write_frequencies(recording.close(), out=tmp_path / "tower.wav")
    assert all(line.isprintable() and len(line) <= 1000 for line in text.read_text().split("\n"))


def test_all_frequencies_are_written_unless_one_is_named(
    recording: Recording, tmp_path: Path
) -> None:
    recording.call("1", 0.0, 0.1)
    recording.call("2", 0.0, 0.2, frequency_khz=121_700)
    folder = recording.close()
    written_files = [wav.name for _, wav, _ in write_frequencies(folder)]
    assert written_files == ["frequency-118300.wav", "frequency-121700.wav"]
    with pytest.raises(RunFolderError, match="--frequency: 118300, 121700"):
        write_frequencies(folder, out=tmp_path / "both.wav")
    [(written, wav, _)] = write_frequencies(folder, 121_700, tmp_path / "ground.wav")
    assert [call["id"] for call in written.calls] == ["2"]
    assert at(read_wav(wav), 0.5) == 0.2


def test_a_frequency_that_nobody_used_is_refused_with_those_in_use(recording: Recording) -> None:
    recording.call("1", 0.0, 0.1)
    with pytest.raises(RunFolderError, match="121500 kHz; expected one of 118300"):
        write_frequencies(recording.close(), 121_500)


def test_a_sound_file_that_was_exchanged_or_is_gone_is_named(recording: Recording) -> None:
    recording.call("1", 0.0, 0.1)
    folder = recording.close()
    write_wav(folder / "audio" / "1.wav", np.full(16_000, 0.3, np.float32))
    with pytest.raises(RunFolderError, match=r"1\.wav: not the sound that the log vouches for"):
        write_frequencies(folder)
    (folder / "audio" / "1.wav").unlink()
    with pytest.raises(RunFolderError, match=r"1\.wav: cannot be read"):
        write_frequencies(folder)


def test_a_name_that_is_no_wav_is_refused(recording: Recording, tmp_path: Path) -> None:
    recording.call("1", 0.0, 0.1)
    with pytest.raises(SpeechError, match=r"ends with \.wav"):
        write_frequencies(recording.close(), out=tmp_path / "tower.txt")


def test_a_run_in_which_nobody_spoke_says_so(recording: Recording) -> None:
    with pytest.raises(RunFolderError, match="nobody said anything"):
        write_frequencies(recording.close())


def test_the_command_prints_a_json_object_for_each_frequency(
    recording: Recording, airhilt_command: Any, tmp_path: Path
) -> None:
    recording.call("1", 0.5, 0.1, heard="hello")
    folder = recording.close()
    done = airhilt_command("listen", folder, "--out", "tower.wav", "--json")
    assert done.returncode == 0, done.stderr
    [printed] = json.loads(done.stdout)
    assert printed["frequency_khz"] == TOWER_KHZ
    assert printed["calls"][0]["heard"][0]["text"] == "hello"
    assert (tmp_path / printed["wav"]).is_file()
    assert (tmp_path / printed["transcript"]).is_file()


def test_a_run_without_sound_says_so_in_one_line(
    recording: Recording, airhilt_command: Any
) -> None:
    recording.silent_call("1", 0.5)
    done = airhilt_command("listen", recording.close())
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert "without sound" in done.stderr


def test_a_disk_that_is_full_leaves_no_part_of_a_file_behind(
    recording: Recording, tmp_path: Path
) -> None:
    recording.call("1", 0.0, 0.1)
    folder = recording.close()
    wav = tmp_path / "tower.wav"
    wav.write_bytes(b"an earlier recording")
    unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1_000, unlimited[1]))
    try:
        with pytest.raises(SpeechError, match=r"tower\.wav: cannot be written"):
            write_frequencies(folder, out=wav)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, unlimited)
    assert wav.read_bytes() == b"an earlier recording"
    assert {path.name for path in tmp_path.iterdir()} == {"run", "tower.wav"}


def test_a_call_late_in_a_day_takes_no_memory_for_the_silence_before_it(
    recording: Recording, tmp_path: Path
) -> None:
    recording.call("1", 1.0, 0.1)
    recording.call("2", 3_600.0, 0.2)
    folder = recording.close()
    tracemalloc.start()
    [(written, wav, _)] = write_frequencies(folder, out=tmp_path / "tower.wav")
    _, peak_bytes = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert written.duration_s == 3_601.0
    assert wav.stat().st_size == 44 + 2 * 16_000 * 3_601
    with wave.open(str(wav)) as file:
        file.setpos(3_600 * 16_000 + 8_000)
        assert from_pcm(file.readframes(1))[0] == pytest.approx(0.2, abs=1e-4)
    assert peak_bytes < 10_000_000


def test_sound_of_another_length_than_the_log_says_is_refused(
    recording: Recording, tmp_path: Path
) -> None:
    recording.call("1", 1.0, 0.1, claimed_samples=10**12)
    with pytest.raises(RunFolderError, match=r"1\.wav: 16000 samples; expected 1000000000000"):
        write_frequencies(recording.close(), out=tmp_path / "tower.wav")
    assert not (tmp_path / "tower.wav").exists()


@pytest.mark.parametrize("begin_s", [90_000.0, 9e9])
def test_a_call_at_a_time_that_no_run_has_is_refused(
    recording: Recording, tmp_path: Path, begin_s: float
) -> None:
    recording.silent_call("1", begin_s)
    with pytest.raises(RunFolderError, match="1 has times that no run has"):
        write_frequencies(recording.close(), out=tmp_path / "tower.wav")
