"""`airhilt verify` says what a run folder proves, and signatures say by whom it is."""

from __future__ import annotations

import json
import stat
from pathlib import Path
from typing import Any

import pytest

from airhilt.record import RunFolder
from airhilt.record.manifest import digest
from damage import break_third_chunk, flip, kill
from verifying import verified


@pytest.fixture
def signed(airhilt_command: Any, keys: Path, run_copy: Path) -> Path:
    assert airhilt_command("sign", run_copy, "--key", keys).returncode == 0
    return run_copy


# --- damage ---------------------------------------------------------------------------------


def test_a_run_as_it_was_written_is_intact_with_a_file_besides(
    airhilt_command: Any, run_copy: Path
) -> None:
    (run_copy / "notes.txt").write_text("run on a Tuesday")
    code, found = verified(airhilt_command, run_copy)
    assert (code, found["state"], found["problems"]) == (0, "intact", [])
    assert found["additional"] == ["notes.txt"]
    assert found["files"] == len(RunFolder(run_copy).info().files) == 3
    assert found["signature"] == "absent"


def test_every_file_of_a_run_is_in_its_manifest(airhilt_command: Any, encounter_file: Path) -> None:
    done = airhilt_command("cosim", "--scenario", encounter_file, "--out", "run")
    assert done.returncode == 0, done.stderr
    folder = encounter_file.parent / "run"
    code, found = verified(airhilt_command, folder)
    assert (code, found["additional"], found["made_again"]) == (0, [], ["report.html"])
    files = RunFolder(folder).info().files
    assert any(name.startswith("audio/") for name in files)
    assert all((folder / name).stat().st_size == file.size_bytes for name, file in files.items())


@pytest.mark.parametrize("name", ["log.mcap", "run.json"])
def test_a_flipped_bit_of_any_file_is_damage(
    airhilt_command: Any, run_copy: Path, name: str
) -> None:
    flip(run_copy / name, 8 * ((run_copy / name).stat().st_size // 2))
    code, found = verified(airhilt_command, run_copy)
    assert (code, found["state"]) == (1, "damaged")
    (problem,) = found["problems"]
    assert problem.startswith(name)


def test_damage_of_the_log_has_its_time(airhilt_command: Any, run_copy: Path) -> None:
    break_third_chunk(run_copy)
    done = airhilt_command("verify", run_copy)
    assert done.returncode == 1
    assert done.stdout.startswith(f"{run_copy}: damaged\n  log.mcap: damaged from 2.")
    assert "messages are missing" in done.stdout


def test_missing_and_additional_files_are_named(airhilt_command: Any, run_copy: Path) -> None:
    (run_copy / "latency.jsonl").unlink()
    (run_copy / "audio").mkdir(exist_ok=True)
    (run_copy / "audio" / "call-99.wav").write_bytes(b"RIFF")
    (run_copy / "frequency-119100.txt").write_text("Tower")
    code, found = verified(airhilt_command, run_copy)
    assert (code, found["problems"]) == (1, ["latency.jsonl: missing"])
    assert found["additional"] == ["audio/call-99.wav"]
    assert found["made_again"] == ["frequency-119100.txt"]


def test_a_killed_run_is_unfinished_or_damaged(airhilt_command: Any, run_copy: Path) -> None:
    kill(run_copy)
    code, found = verified(airhilt_command, run_copy)
    assert (code, found["state"]) == (3, "unfinished")
    assert found["ended"].startswith("its log has messages up to 7.")
    break_third_chunk(run_copy)
    code, found = verified(airhilt_command, run_copy)
    assert (code, found["state"]) == (1, "damaged")


def test_a_manifest_cannot_name_a_file_elsewhere(airhilt_command: Any, run_copy: Path) -> None:
    (run_copy.parent / "secret.txt").write_text("secret")
    tamper(
        run_copy,
        lambda document: document["files"].update(
            {"../secret.txt": {"sha256": "0", "size_bytes": 6}}
        ),
    )
    code, found = verified(airhilt_command, run_copy)
    assert code == 1
    assert found["problems"][0].startswith("../secret.txt: outside of the folder")


def test_a_manifest_with_a_name_that_no_file_can_have_is_damage(
    airhilt_command: Any, run_copy: Path
) -> None:
    record = {"sha256": "0" * 64, "size_bytes": 0}
    names = ("x" * 5000, "a\0b", ".")
    tamper(run_copy, lambda document: document["files"].update(dict.fromkeys(names, record)))
    code, found = verified(airhilt_command, run_copy)
    assert (code, found["state"]) == (1, "damaged")
    assert any("cannot be read: File name too long" in one for one in found["problems"])


def test_pictures_and_videos_are_in_the_manifest(run_copy: Path) -> None:
    names = {"pictures/start-nose-0.jpg", "pictures/first_warning-nose-1.png", "video/nose.mp4"}
    for name in names:
        (run_copy / name).parent.mkdir(exist_ok=True)
        (run_copy / name).write_bytes(b"seen")
    assert names < RunFolder(run_copy).manifest().keys()


def test_a_folder_without_a_run_is_a_mistake(airhilt_command: Any, tmp_path: Path) -> None:
    done = airhilt_command("verify", tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert "neither a run nor a sweep" in done.stderr


# --- signatures -----------------------------------------------------------------------------


def tamper(folder: Path, change: Any) -> None:
    """Change ``run.json``, and make its hash right again, as somebody would on purpose."""
    path = folder / "run.json"
    document = json.loads(path.read_text())
    change(document)
    document["digest"] = digest(document)
    path.write_text(json.dumps(document, indent=2))


def test_a_signed_run_is_good_by_its_key_alone(
    airhilt_command: Any, signed: Path, keys: Path, tmp_path: Path
) -> None:
    code, found = verified(airhilt_command, signed, "--key", f"{keys}.pub")
    assert (code, found["state"], found["signature"]) == (0, "intact", "good")
    assert found["additional"] == []
    assert airhilt_command("keys", "sign", tmp_path / "other.key").returncode == 0
    code, found = verified(airhilt_command, signed, "--key", tmp_path / "other.key.pub")
    assert (code, found["state"], found["signature"]) == (1, "intact", "bad")
    code, found = verified(airhilt_command, signed)
    assert (code, found["signature"]) == (0, "unchecked")


def test_a_manifest_that_was_changed_on_purpose_is_not_genuine(
    airhilt_command: Any, signed: Path, keys: Path
) -> None:
    tamper(signed, lambda document: document["options"].update(seed=7))
    code, found = verified(airhilt_command, signed)
    assert (code, found["state"]) == (0, "intact")
    code, found = verified(airhilt_command, signed, "--key", f"{keys}.pub")
    assert (code, found["signature"]) == (1, "bad")


def test_a_file_that_was_changed_after_signing_is_damage(
    airhilt_command: Any, signed: Path, keys: Path
) -> None:
    (signed / "summary.json").write_text("{}")
    code, found = verified(airhilt_command, signed, "--key", f"{keys}.pub")
    assert (code, found["state"], found["signature"]) == (1, "damaged", "good")


def test_a_signature_that_is_none_is_bad(airhilt_command: Any, signed: Path, keys: Path) -> None:
    for content in (b"", b"x" * 64, b"x" * 1000):
        (signed / "run.json.sig").write_bytes(content)
        code, found = verified(airhilt_command, signed, "--key", f"{keys}.pub")
        assert (code, found["signature"]) == (1, "bad")


def test_a_run_without_the_signature_that_was_asked_for_is_not_genuine(
    airhilt_command: Any, run_copy: Path, keys: Path
) -> None:
    code, found = verified(airhilt_command, run_copy, "--key", f"{keys}.pub")
    assert (code, found["signature"]) == (1, "absent")


def test_only_a_run_that_is_intact_is_signed_and_only_once(
    airhilt_command: Any, signed: Path, keys: Path
) -> None:
    done = airhilt_command("sign", signed, "--key", keys)
    assert (done.returncode, "signed already" in done.stderr) == (2, True)
    (signed / "run.json.sig").unlink()
    (signed / "latency.jsonl").unlink()
    done = airhilt_command("sign", signed, "--key", keys)
    assert done.returncode == 2
    assert "damaged: latency.jsonl: missing; expected a run that is intact" in done.stderr
    kill(signed)
    done = airhilt_command("sign", signed, "--key", keys)
    assert (done.returncode, "unfinished" in done.stderr) == (2, True)
    assert not (signed / "run.json.sig").exists()


def test_a_run_over_a_signed_one_is_not_signed(airhilt_command: Any, encounter_file: Path) -> None:
    command = ("cosim", "--scenario", encounter_file, "--assistant", "none", "--no-speech")
    assert airhilt_command(*command, "--out", "run").returncode == 0
    assert airhilt_command("keys", "sign").returncode == 0
    assert airhilt_command("sign", "run", "--key", "airhilt.key").returncode == 0
    assert airhilt_command(*command, "--out", "run", "--overwrite").returncode == 0
    code, found = verified(airhilt_command, "run")
    assert (code, found["signature"]) == (0, "absent")


# --- keys -----------------------------------------------------------------------------------


def test_a_private_key_is_for_its_owner_alone_and_never_overwritten(
    airhilt_command: Any, keys: Path
) -> None:
    assert stat.S_IMODE(keys.stat().st_mode) == 0o600
    before = keys.read_bytes()
    done = airhilt_command("keys", "sign", keys)
    assert (done.returncode, "is there already" in done.stderr) == (2, True)
    keys.rename(keys.with_name("kept.key"))
    done = airhilt_command("keys", "sign", keys)
    assert (done.returncode, f"{keys}.pub: is there already" in done.stderr) == (2, True)
    assert keys.with_name("kept.key").read_bytes() == before
    assert not keys.exists()


@pytest.mark.parametrize("mode", [0o604, 0o620])
def test_a_private_key_that_others_may_read_or_change_signs_nothing(
    airhilt_command: Any, run_copy: Path, keys: Path, mode: int
) -> None:
    keys.chmod(mode)
    done = airhilt_command("sign", run_copy, "--key", keys)
    assert done.returncode == 2
    assert f"{keys}: other users may read or change this private key" in done.stderr
    assert f"chmod 600 {keys}" in done.stderr
    assert not (run_copy / "run.json.sig").exists()


def test_a_key_of_the_wrong_kind_is_a_named_mistake(
    airhilt_command: Any, run_copy: Path, keys: Path, tmp_path: Path
) -> None:
    (tmp_path / "text").write_text("no key")
    for key in (keys, tmp_path / "text", run_copy / "log.mcap"):
        done = airhilt_command("verify", run_copy, "--key", key)
        assert (done.returncode, "no public key" in done.stderr) == (2, True)
    for key in (keys.with_name("lab.key.pub"), tmp_path / "text"):
        done = airhilt_command("sign", run_copy, "--key", key)
        assert (done.returncode, "no private key" in done.stderr) == (2, True)
    done = airhilt_command("sign", run_copy, "--key", tmp_path / "missing")
    assert (done.returncode, "cannot be read" in done.stderr) == (2, True)


def test_a_run_without_a_hash_of_its_record_is_damaged_and_not_signed(
    airhilt_command: Any, keys: Path, run_copy: Path
) -> None:
    path = run_copy / "run.json"
    document = json.loads(path.read_text())
    path.write_text(json.dumps(document | {"digest": ""}))
    code, found = verified(airhilt_command, run_copy)
    assert (code, found["state"]) == (1, "damaged")
    assert found["problems"] == ["run.json: damaged or changed: not what its digest says"]
    done = airhilt_command("sign", run_copy, "--key", keys)
    assert (done.returncode, "expected a run that is intact" in done.stderr) == (2, True)
