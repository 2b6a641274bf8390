"""Says whether the folder of a run or a sweep is as it was written, and by whom it is signed."""

from __future__ import annotations

from collections.abc import Set as AbstractSet
from contextlib import nullcontext
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath
from typing import Literal

from airhilt.errors import AirhiltError, SignatureError
from airhilt.record.folder import RunFolder
from airhilt.record.log_reader import LogReader
from airhilt.record.manifest import digest_problem, problem_of
from airhilt.record.run import Run
from airhilt.record.signature import (
    fingerprint,
    is_signed_by,
    private_key,
    public_key,
    sign,
)
from airhilt.record.sweep_folder import SweepFolder, is_sweep
from airhilt.units import SECOND_NS

MADE_AGAIN = ("report.html", "frequency-*.wav", "frequency-*.txt", "figures/*", "export/*")
"""Names of the files that commands make from a run or a sweep, and that no manifest has."""
DAMAGED, UNFINISHED = 1, 3
"""Exit codes of what is damaged, or not that of the key, and of what has no end or no manifest."""


@dataclass(frozen=True)
class Verification:
    """The state of the folder of a run or a sweep, which is `run`."""

    run: str
    kind: Literal["run", "sweep"]
    state: Literal["intact", "damaged", "unfinished"] = "damaged"
    """``intact``: each file of the manifest is as it was written. ``unfinished``: a run has no
    manifest, because it was killed or goes on; a sweep has not written its tables yet."""
    ended: str = ""
    """Readable part of an unfinished log, or tables of an unfinished sweep, in words."""
    files: int = 0
    """Number of files in the manifest."""
    problems: tuple[str, ...] = ()
    """A line for each file that is missing or not as the run wrote it."""
    additional: tuple[str, ...] = ()
    """Files in the folder that the run or the sweep did not write."""
    made_again: tuple[str, ...] = ()
    """Files that can be made again from the others, and were not checked."""
    signature: Literal["absent", "unchecked", "good", "bad"] = "absent"
    """``unchecked``: there is one, and no key was given."""
    key: str = ""
    """Fingerprint of the key that was given, empty without one."""

    @property
    def exit_code(self) -> int:
        """0 if the folder is intact, and signed by the key if one was given."""
        if self.state == "damaged" or (self.key and self.signature != "good"):
            return DAMAGED
        return 0 if self.state == "intact" else UNFINISHED

    def __str__(self) -> str:
        kind, key = self.kind, self.key
        heads = {
            "intact": f"intact: {self.files} files are as the {kind} wrote them",
            "damaged": "damaged",
            "unfinished": f"unfinished: the {kind} was killed, or is still going on; {self.ended}",
        }
        signatures = {
            "absent": f"none; whoever can change the {kind} can change its manifest too",
            "unchecked": "not checked; give the public key with --key",
            "good": f"good, by the key {key}",
            "bad": f"bad: not by the key {key}, or {kind}.json was changed after it",
        }
        lines = [f"{self.run}: {heads[self.state]}", *(f"  {each}" for each in self.problems)]
        lines.append(f"signature: {signatures[self.signature]}")
        if self.additional:
            lines.append(f"not written by the {kind}: {', '.join(self.additional)}")
        if self.made_again:
            lines.append(f"made from the {kind}, and not checked: {', '.join(self.made_again)}")
        return "\n".join(lines)


def verify(path: Path, key: Path | None = None) -> Verification:
    """Compare every file of a run or a sweep with its manifest, and its signature with a key.

    It raises `SweepFolderError` if there is neither, and `SignatureError` if the key cannot be
    read.
    """
    folder = SweepFolder(path) if is_sweep(path) else RunFolder(path)
    given = None if key is None else public_key(key)
    found = _sweep(folder) if isinstance(folder, SweepFolder) else _run(folder)
    if given is not None:
        found = replace(found, key=fingerprint(given))
    if not folder.signature_path.is_file():
        return found
    if given is None:
        return replace(found, signature="unchecked")
    return replace(found, signature="good" if is_signed_by(folder, given) else "bad")


def sign_folder(path: Path, key: Path) -> str:
    """Sign a run or a sweep that is intact, and return the fingerprint of the key.

    It raises `SignatureError` if it is not intact, or signed already, or the key is none, and
    `SweepFolderError` if there is neither a run nor a sweep, or the sweep is going on.
    """
    signer = private_key(key)
    sweep = SweepFolder(path)
    is_of_sweep = is_sweep(path)
    with sweep.locked() if is_of_sweep and sweep.parts_path.is_dir() else nullcontext():
        found = verify(path)
        if found.state != "intact":
            said = f": {found.problems[0]}" if found.problems else ""
            raise SignatureError(
                f"{path}: {found.state}{said}; expected a {found.kind} that is intact"
            )
        sign(sweep if is_of_sweep else RunFolder(path), signer)
    return fingerprint(signer.public_key())


def _run(folder: RunFolder) -> Verification:
    found = Verification(str(folder.path), "run")
    try:
        info = folder.info()
    except AirhiltError as error:
        return replace(found, problems=(str(error).replace(f"{folder.path}/", ""),))
    problems = Run(folder).damage_of_all_files()
    found = replace(found, files=len(info.files))
    if info.phase == "running":
        state: Literal["damaged", "unfinished"] = "damaged" if problems else "unfinished"
        return replace(found, state=state, problems=problems, ended=_ended(folder))
    log = folder.log_path.name
    if log not in info.files:
        problems = (*problems, f"run.json: its manifest has no {log}")
    known = {*info.files, folder.info_path.name, folder.signature_path.name}
    additional, made_again = _others(folder.path, known)
    return replace(
        found,
        state="damaged" if problems else "intact",
        problems=problems,
        additional=additional,
        made_again=made_again,
    )


def _ended(folder: RunFolder) -> str:
    reader = LogReader(folder.log_path)
    try:
        for _ in reader.messages():
            pass
    except AirhiltError:
        return "its log cannot be read"
    return f"its log has messages up to {reader.end_ns / SECOND_NS:.3f} s"


def _sweep(folder: SweepFolder) -> Verification:
    found = Verification(str(folder.path), "sweep")
    if not folder.info_path.is_file():
        return replace(found, state="unfinished", ended="it has no tables yet")
    try:
        info, files = folder.info(), folder.files()
    except AirhiltError as error:
        return replace(found, problems=(str(error).replace(f"{folder.path}/", ""),))
    tables = folder.table_path.name, folder.machine_path.name
    problems = [
        digest_problem(folder.info_path.name, info),
        *(f"sweep.json: its manifest has no {name}" for name in tables if name not in files),
    ]
    runs = {str(PurePosixPath(name).parent) for name in files if name not in tables}
    known = {folder.info_path.name, folder.signature_path.name, folder.next_info_path.name, *files}
    additional, made_again = _others(folder.path, known, {folder.parts_path.name, *runs})
    for name, record in files.items():
        problem = problem_of(folder.path, name, record, folder.info_path.name)
        problems.append(problem)
        if name not in tables and not problem:
            run = PurePosixPath(name).parent
            inner = _run(RunFolder(folder.path / run))
            problems += (f"{run}/{line}" for line in inner.problems)
            additional += tuple(f"{run}/{other}" for other in inner.additional)
            made_again += tuple(f"{run}/{other}" for other in inner.made_again)
    problems = [problem for problem in problems if problem]
    is_unfinished = folder.next_info_path.is_file()
    if not problems:
        found = replace(found, state="unfinished" if is_unfinished else "intact")
    return replace(
        found,
        ended="its tables are of what was run before" if is_unfinished else "",
        files=len(files),
        problems=tuple(problems),
        additional=additional,
        made_again=made_again,
    )


def _others(
    folder: Path, known: AbstractSet[str], elsewhere: AbstractSet[str] = frozenset()
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the files that no manifest has and that lie not elsewhere, and those made again."""
    names = sorted(
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_symlink() or not path.is_dir()
    )
    others = [
        name
        for name in names
        if name not in known and elsewhere.isdisjoint(map(str, PurePosixPath(name).parents))
    ]
    made_again = [name for name in others if any(fnmatchcase(name, one) for one in MADE_AGAIN)]
    return tuple(name for name in others if name not in made_again), tuple(made_again)
