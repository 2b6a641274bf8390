"""Says whether a run folder is as its run wrote it, and by whom it is signed."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Literal

from airhilt.errors import RunFolderError, SignatureError
from airhilt.record.folder import RunFolder, RunInfo
from airhilt.record.log_reader import LogReader
from airhilt.record.run import Run
from airhilt.record.signature import fingerprint, is_signed_by, private_key, public_key, sign
from airhilt.units import SECOND_NS

MADE_AGAIN = ("report.html", "frequency-*.wav", "frequency-*.txt")
"""Names of the files that commands make from a run, and that no manifest has."""
DAMAGED, UNFINISHED = 1, 3
"""Exit codes of a run that is damaged, or not that of the key, and of one without an end."""


@dataclass(frozen=True)
class Verification:
    """The state of a run folder.

    Attributes
    ----------
    run
        The folder.
    state
        ``intact``: each file of the manifest is as the run wrote it. ``unfinished``: there is no
        manifest, because the run was killed or goes on.
    ended
        How far an unfinished log can be read, in words; empty for another.
    files
        Number of files in the manifest.
    problems
        A line for each file that is missing or not as the run wrote it.
    additional
        Files in the folder that the run did not write.
    made_again
        Files that can be made again from the run, and were not checked.
    signature
        ``unchecked``: there is one, and no key was given.
    key
        Fingerprint of the key that was given, empty without one.
    has_digest
        False if ``run.json`` has no hash of itself, as version 0.5 wrote none: what it says was not
        checked, and of the files the log alone.
    """

    run: str
    state: Literal["intact", "damaged", "unfinished"]
    ended: str
    files: int
    problems: tuple[str, ...]
    additional: tuple[str, ...]
    made_again: tuple[str, ...]
    signature: Literal["absent", "unchecked", "good", "bad"]
    key: str
    has_digest: bool = True

    @property
    def exit_code(self) -> int:
        """0 if the run is intact, and signed by the key if one was given."""
        if self.state == "damaged" or (self.key and self.signature != "good"):
            return DAMAGED
        return UNFINISHED if self.state == "unfinished" else 0

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return asdict(self)

    def __str__(self) -> str:
        match self.state:
            case "intact":
                head = f"intact: {self.files} files are as the run wrote them"
            case "damaged":
                head = "damaged"
            case "unfinished":
                head = f"unfinished: the run was killed, or is still going on; {self.ended}"
        lines = [f"{self.run}: {head}", *(f"  {problem}" for problem in self.problems)]
        if not self.has_digest:
            lines.append(
                "run.json has no hash of itself, as in version 0.5, and was not checked; of the "
                "files, those in its manifest were"
            )
        lines.append(f"signature: {self._signature_text()}")
        if self.additional:
            lines.append(f"not written by the run: {', '.join(self.additional)}")
        if self.made_again:
            lines.append(f"made from the run, and not checked: {', '.join(self.made_again)}")
        return "\n".join(lines)

    def _signature_text(self) -> str:
        match self.signature:
            case "absent":
                return "none; whoever can change the run can change its manifest too"
            case "unchecked":
                return "not checked; give the public key with --key"
            case "good":
                return f"good, by the key {self.key}"
            case "bad":
                return f"bad: not by the key {self.key}, or run.json was changed after it"


def verify(path: Path, key: Path | None = None) -> Verification:
    """Compare every file of a run with its manifest, and its signature with a public key.

    Raises
    ------
    RunFolderError
        There is no run.
    SignatureError
        The key cannot be read.
    """
    folder = RunFolder.open(path)
    signature, mark = _signature(folder, key)
    try:
        info = folder.info()
    except RunFolderError as error:
        problem = str(error).replace(f"{path}/", "")
        return Verification(str(path), "damaged", "", 0, (problem,), (), (), signature, mark)
    problems = _problems(folder, info)
    is_unfinished = info.phase == "running"
    others = [] if is_unfinished else _others(folder, info)
    made_again = [name for name in others if _is_made_again(name)]
    state: Literal["unfinished", "intact"] = "unfinished" if is_unfinished else "intact"
    return Verification(
        str(path),
        "damaged" if problems else state,
        _ended(folder) if is_unfinished else "",
        len(info.files),
        tuple(problems),
        tuple(name for name in others if name not in made_again),
        tuple(made_again),
        signature,
        mark,
        bool(info.digest),
    )


def sign_run(path: Path, key: Path) -> str:
    """Sign a run that is intact, and return the fingerprint of the key.

    Raises
    ------
    RunFolderError
        There is no run.
    SignatureError
        It is not intact, or signed already, or the key is none.
    """
    signer = private_key(key)
    found = verify(path)
    if found.state != "intact":
        said = f": {found.problems[0]}" if found.problems else ""
        raise SignatureError(f"{path}: {found.state}{said}; expected a run that is intact")
    folder = RunFolder.open(path)
    if not folder.info().digest:
        raise SignatureError(
            f"{path}: recorded by an earlier version, whose manifest has its log alone; expected a "
            "run of this version"
        )
    sign(folder, signer)
    return fingerprint(signer.public_key())


def _signature(
    folder: RunFolder, key: Path | None
) -> tuple[Literal["absent", "unchecked", "good", "bad"], str]:
    """Return the state of the signature, and the fingerprint of the key."""
    given = None if key is None else public_key(key)
    mark = "" if given is None else fingerprint(given)
    if not folder.signature_path.is_file():
        return "absent", mark
    if given is None:
        return "unchecked", mark
    return ("good" if is_signed_by(folder, given) else "bad"), mark


def _problems(folder: RunFolder, info: RunInfo) -> list[str]:
    log = folder.log_path.name
    lines = list(Run(folder).damage_of_all_files())
    if info.phase != "running" and log not in info.files:
        lines.append(f"run.json: its manifest has no {log}")
    return lines


def _ended(folder: RunFolder) -> str:
    """Return how far the log of an unfinished run can be read."""
    reader = LogReader(folder.log_path)
    try:
        for _ in reader.messages():
            pass
    except RunFolderError:
        return "its log cannot be read"
    return f"its log has messages up to {reader.end_ns / SECOND_NS:.3f} s"


def _others(folder: RunFolder, info: RunInfo) -> list[str]:
    """Return the files in the folder that are not in the manifest."""
    known = {*info.files, folder.info_path.name, folder.signature_path.name}
    names = (
        path.relative_to(folder.path).as_posix()
        for path in folder.path.rglob("*")
        if path.is_symlink() or not path.is_dir()
    )
    return sorted(name for name in names if name not in known)


def _is_made_again(name: str) -> bool:
    return any(fnmatchcase(name, pattern) for pattern in MADE_AGAIN)
