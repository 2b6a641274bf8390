"""What is on the air lies beside the log as WAV files, and the log vouches for them."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from airhilt import run
from airhilt.audio.pcm import to_pcm
from airhilt.audio.wav import read_wav
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.cosim.replay import replay
from airhilt.errors import RunFolderError
from airhilt.messages import (
    AdvisoryAudio,
    Transmission,
    TransmissionChunk,
    TransmissionClosed,
)
from airhilt.record import RunFolder, read_log
from airhilt.record.audio import AudioRecorder, audio_file, recorded_pcm
from airhilt.scenario import Scenario

FULL = Path("/dev/full")
PCM = bytes(range(256)) * 8

needs_full = pytest.mark.skipif(not FULL.exists(), reason="needs /dev/full")


def received(name: str = "call", pcm: bytes = PCM) -> Transmission:
    sha256 = hashlib.sha256(pcm).hexdigest()
    return Transmission(
        id=name, frequency_khz=134_325, t_tx_ns=0, t_end_ns=5, samples=len(pcm) // 2, sha256=sha256
    )


def spoken(recipient: str, revision: int = 0) -> AdvisoryAudio:
    return AdvisoryAudio(
        id="decision-1",
        revision=revision,
        recipient=recipient,
        text="Traffic",
        t_dec_ns=0,
        engine="tone",
        samples=len(PCM) // 2,
        sha256=hashlib.sha256(PCM).hexdigest(),
    )


@pytest.fixture(scope="module")
def short(encounter: Scenario) -> Scenario:
    """The encounter up to its second call."""
    return encounter.model_copy(update={"duration_s": 20.0})


@pytest.fixture(scope="module")
def recorded(short: Scenario, tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    out = tmp_path_factory.mktemp("recorded") / "run"
    return RunFolder(run(short, out=out, latency="fixed", snr_db=10.0).folder)


def sounds_of(folder: RunFolder) -> list[Transmission | AdvisoryAudio]:
    """Return the messages of a run that have sound."""
    sounds: list[Transmission | AdvisoryAudio] = []
    for logged in read_log(folder.log_path):
        match logged.key.split("/"):
            case ["radio", _, "tx"]:
                sounds.append(Transmission.model_validate_json(logged.data))
            case ["tts", _]:
                sounds.append(AdvisoryAudio.model_validate_json(logged.data))
    return sounds


def test_every_call_and_every_voice_has_a_file_with_the_samples_of_the_log(
    recorded: RunFolder,
) -> None:
    sounds = sounds_of(recorded)
    expected: list[type] = [Transmission, AdvisoryAudio]
    assert {type(sound) for sound in sounds} == set(expected)
    assert {audio_file(recorded.audio_path, sound) for sound in sounds} == set(
        recorded.audio_path.iterdir()
    )
    for sound in sounds:
        pcm = to_pcm(read_wav(audio_file(recorded.audio_path, sound)))
        assert len(pcm) == 2 * sound.samples > 0
        assert hashlib.sha256(pcm).hexdigest() == sound.sha256


def test_the_file_of_a_call_has_its_name(recorded: RunFolder) -> None:
    calls = [sound.id for sound in sounds_of(recorded) if isinstance(sound, Transmission)]
    assert set(calls) >= {"check-in-aal", "check-in-dal", "controller.Washington_Center.1"}
    assert (recorded.audio_path / "check-in-aal.wav").is_file()


def test_a_run_without_speech_has_no_sounds(short: Scenario, tmp_path: Path) -> None:
    folder = RunFolder(run(short, out=tmp_path / "run", speech=False).folder)
    assert not folder.audio_path.exists()


# --- files and their names ----------------------------------------------------------------------


def test_each_who_is_told_and_each_revision_has_a_file(tmp_path: Path) -> None:
    told = [spoken("AAL123"), spoken("ATC"), spoken("ATC", revision=1)]
    assert len({audio_file(tmp_path, one) for one in told}) == 3


def test_a_name_cannot_lead_out_of_the_folder(tmp_path: Path) -> None:
    for name in ("../../etc/passwd", "/etc/passwd", "a/b", "a\\b", "a\0b"):
        assert audio_file(tmp_path, received(name)).parent == tmp_path


def test_what_was_written_is_read_again(tmp_path: Path) -> None:
    AudioRecorder(tmp_path / "audio").take("radio/134325/tx", received(), PCM)
    assert recorded_pcm(tmp_path / "audio", received()) == PCM


def closed(*, is_complete: bool) -> TransmissionClosed:
    return TransmissionClosed(
        id="call", frequency_khz=134_325, t_tx_ns=0, t_end_ns=5, samples=len(PCM) // 2,
        sha256=hashlib.sha256(PCM).hexdigest(), is_complete=is_complete,
    )  # fmt: skip


@pytest.mark.parametrize("is_complete", [True, False])
def test_chunks_have_a_file_only_if_no_transmission_has_their_samples(
    tmp_path: Path, is_complete: bool
) -> None:
    recorder = AudioRecorder(tmp_path / "audio")
    for seq, begin in enumerate(range(0, len(PCM), 512)):
        pcm = PCM[begin : begin + 512]
        chunk = TransmissionChunk(
            id="call", frequency_khz=134_325, seq=seq, first_sample=begin // 2, samples=256,
            sha256=hashlib.sha256(pcm).hexdigest(),
        )  # fmt: skip
        recorder.take("radio/134325/audio", chunk, pcm)
    message = closed(is_complete=is_complete)
    recorder.take("radio/134325/audio", message, b"")
    assert audio_file(tmp_path / "audio", message).exists() is not is_complete
    if not is_complete:
        assert recorded_pcm(tmp_path / "audio", message) == PCM


# --- disks that are full ------------------------------------------------------------------------


@needs_full
def test_a_full_disk_is_named_with_the_file(tmp_path: Path) -> None:
    (tmp_path / "call.wav").symlink_to(FULL)
    with pytest.raises(RunFolderError, match=r"call\.wav: .*No space left.*make room"):
        AudioRecorder(tmp_path).take("radio/134325/tx", received(), PCM)
    assert not (tmp_path / "call.wav").is_symlink(), "no half a file stays"


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "run").write_text("a file")
    with pytest.raises(RunFolderError, match=r"cannot be written any more.*--out"):
        AudioRecorder(tmp_path / "run" / "audio").take("radio/134325/tx", received(), PCM)


@needs_full
def test_a_disk_that_fills_up_with_sound_stops_the_run_and_keeps_its_log(
    short: Scenario, tmp_path: Path
) -> None:
    class FillsTheDisk(Observer):
        def snapshot(self, snapshot: Snapshot) -> None:
            path = tmp_path / "run" / "audio" / "check-in-dal.wav"
            if snapshot.t_s >= 10.0 and not path.is_symlink():
                path.symlink_to(FULL)

    with pytest.raises(RunFolderError, match=r"check-in-dal\.wav: .*No space left.*make room"):
        run(short, out=tmp_path / "run", latency="fixed", observer=FillsTheDisk())
    folder = RunFolder(tmp_path / "run")
    assert folder.info().phase == "stopped"
    assert "No space left" in folder.info().cause
    assert "No space left" in (folder.summary() or {})["outcome"]
    calls = [sound.id for sound in sounds_of(folder) if isinstance(sound, Transmission)]
    assert set(calls) >= {"check-in-aal", "check-in-dal", "controller.Washington_Center.1"}
    assert (folder.audio_path / "check-in-aal.wav").is_file()
    assert not (folder.audio_path / "check-in-dal.wav").exists()
    assert replay(folder.path).identical
