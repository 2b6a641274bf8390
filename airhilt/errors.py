"""Errors for people: what is wrong, where, what was expected, and what to do."""

from __future__ import annotations

import reprlib
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pydantic import ValidationError

OUT_OF_MEMORY = (
    "can't start new thread",
    "Cannot allocate memory",
    "bad_alloc",
    "failed to map segment",
)
"""Parts of what Python, the system, C++ and the loader of libraries say if they get no memory."""


class AirhiltError(Exception):
    """A mistake in what AIRHILT was given; the command line prints it and exits with 2.

    Attributes
    ----------
    is_of_machine
        True if the cause lies in the machine, not in the input: a process was killed, a service
        does not answer, a disk is full.
    is_passing
        True if the next attempt may succeed: a worker goes on without this one result.
    """

    exit_code = 2
    is_of_machine = False
    is_passing = False


class RunStopped(AirhiltError):
    """A run ended early because it was told to be strict; nobody made a mistake."""

    exit_code = 3


class ScenarioError(AirhiltError):
    """A scenario, aircraft or airport file does not say what it must.

    Attributes
    ----------
    problems
        All that is wrong with it, a line each; the message is about the first.
    """

    def __init__(self, message: str, problems: tuple[str, ...] = ()) -> None:
        super().__init__(message)
        self.problems = problems or (message,)


class SensorError(AirhiltError):
    """A sensor cannot be loaded, or publishes on keys that are not its own."""


class BusError(AirhiltError):
    """The Zenoh session could not be opened, or something on it broke its contract."""


class RunFolderError(AirhiltError):
    """A run folder cannot be written, or does not hold what it must."""

    is_of_machine = True


class SignatureError(AirhiltError):
    """A file is no signing key, or a run cannot be signed."""


class StationError(AirhiltError):
    """A station cannot be opened at that address, or is not installed."""


@contextmanager
def writing_to_run(path: object) -> Iterator[None]:
    """Convert OSError to the error for a file of a run that cannot be written any more."""
    try:
        yield
    except OSError as error:
        raise RunFolderError(
            f"{path}: cannot be written any more: {error.strerror}; make room, or choose another "
            "folder with --out"
        ) from None


class WorkerError(AirhiltError):
    """A worker broke its contract: it answered garbage, or with a time in the past."""


class SpeechError(AirhiltError):
    """A voice, a radio channel, a model of speech or its service does not do what it must."""


class CameraError(AirhiltError):
    """A camera cannot be used: it stands inside an object, or its numbers are impossible."""


class RendererError(AirhiltError):
    """Pictures cannot be drawn: something is not installed, or the renderer has died."""


class RendererLost(RendererError):
    """The process that draws has ended, does not answer, or has no room."""

    is_of_machine = True


class VideoError(AirhiltError):
    """A video cannot be written: something is not installed, or FFmpeg refuses."""


class VisionError(AirhiltError):
    """A detector, its model or its service does not do what it must."""


class LanguageModelError(AirhiltError):
    """A language model does not answer, refuses, or is not at the address that was given."""


@contextmanager
def keeping_passing(missed: list[str]) -> Iterator[None]:
    """Append the text of an error that is passing to a list; other errors are raised."""
    try:
        yield
    except AirhiltError as error:
        if not error.is_passing:
            raise
        missed.append(str(error))


def is_of_machine(error: BaseException) -> bool:
    """Return whether the cause of an error lies in the machine, not in the input."""
    if isinstance(error, AirhiltError):
        return error.is_of_machine
    return isinstance(error, OSError) or is_out_of_memory(error)


def is_out_of_memory(error: BaseException) -> bool:
    """Return whether memory ran out; Python and native libraries say so in different ways."""
    said = str(error)
    return isinstance(error, MemoryError) or any(symptom in said for symptom in OUT_OF_MEMORY)


def first_problem(error: ValidationError) -> str:
    """Return the first thing that pydantic found wrong, in one line, after its place."""
    where, what = next(_problems(error))
    return f"{where}: {what}" if where else what


def all_problems(error: ValidationError) -> str:
    """Return all that pydantic found wrong, in one line, each after its places."""
    places: dict[str, list[str]] = {}
    for where, what in _problems(error):
        places.setdefault(what, []).append(where)
    return "; ".join(
        ": ".join(filter(None, (", ".join(found), what))) for what, found in places.items()
    )


def _problems(error: ValidationError) -> Iterator[tuple[str, str]]:
    """Yield the place of each problem, and what is wrong there."""
    for each in error.errors(include_url=False, include_context=False, include_input=False):
        where = "/".join(str(part) for part in each["loc"])
        what = each["msg"].removeprefix("Value error, ")
        yield where, what


def shown(value: object) -> str:
    """Return a value as an error shows it: in one line, and cut where it is long."""
    return " ".join(reprlib.repr(value).split())


def first_line(error: BaseException) -> str:
    """Return kind and first line of what a library raised; some write pages."""
    lines = str(error).strip().splitlines()
    return f"{type(error).__name__}: {lines[0]}" if lines else type(error).__name__


def failure_in(error: Exception) -> str:
    """Return what another package's code raised, in one line, with the line of code that did."""
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({Path(frames[-1].filename).name}, line {frames[-1].lineno})" if frames else ""
    return f"{first_line(error)}{where}"


@contextmanager
def blaming(
    what: str, error: type[AirhiltError] = AirhiltError, *declared: type[Exception]
) -> Iterator[None]:
    """Raise what another package's code raises as an error that says what failed.

    Parameters
    ----------
    what
        What failed, such as ``sensor 'lidar' does not start``.
    error
        Class of the error.
    declared
        Exceptions that the code may raise; they pass unchanged, as an `AirhiltError` does.
    """
    try:
        yield
    except Exception as cause:
        if isinstance(cause, (AirhiltError, *declared)):
            raise
        raise error(f"{what}: {failure_in(cause)}") from cause
