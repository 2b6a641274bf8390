"""Engines: members of a family that the command line chooses by name, path or address.

Speech recognisers, voices, detectors, decision engines and wordings are such families
(`airhilt.engine_families`). A member is one module with one `Engine`, or an entry point that names
one:

    [project.entry-points."airhilt.asr"]
    mine = "my_package.asr:ENGINE"
"""

from __future__ import annotations

import importlib.metadata
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from airhilt.errors import AirhiltError, first_line
from airhilt.host.library import nearest
from airhilt.host.services import is_service
from airhilt.plugins import Family, missing

if TYPE_CHECKING:
    from pydantic import BaseModel

RENDERER_HELP = (
    "What draws pictures: auto (embree whatever else is installed, open3d where it cannot be had), "
    "fastest (moderngl where it can draw), embree, open3d, moderngl, or a renderer "
    "of another package."
)
"""Help of ``--renderer``, for runs and for the commands that draw pictures."""

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)


class Requirement(Protocol):
    """Something that must be installed before an engine works."""

    def found(self) -> str:
        """Return its name and version, or its path; empty if it is missing."""

    def remedy(self) -> str:
        """Return how to get it."""


@dataclass(frozen=True)
class Package:
    """A Python distribution, and the extra of AIRHILT that brings it."""

    name: str
    extra: str

    def found(self) -> str:
        """Return name and version; empty if it is not installed."""
        try:
            return f"{self.name} {importlib.metadata.version(self.name)}"
        except importlib.metadata.PackageNotFoundError:
            return ""

    def remedy(self) -> str:
        """Return the command that installs it."""
        return f"pip install 'airhilt[{self.extra}]'"

    @contextmanager
    def importing(self) -> Iterator[None]:
        """Convert an ImportError within to an `AirhiltError` that says how to get the package."""
        try:
            yield
        except ImportError as error:
            raise AirhiltError(
                f"the package {self.name} is missing or does not load ({first_line(error)}); "
                f"install it with `{self.remedy()}`"
            ) from None


@dataclass(frozen=True)
class Command:
    """A program on PATH, and the Debian package that has it."""

    name: str
    debian: str

    def found(self) -> str:
        """Return its path; empty if there is none."""
        return shutil.which(self.name) or ""

    def remedy(self) -> str:
        """Return the command that installs it."""
        return f"apt install {self.debian}"


@dataclass(frozen=True)
class Engine(Generic[T_co]):
    """One member of a family: how it is asked for, what it needs, and how it is made.

    Attributes
    ----------
    name
        Name of the module or entry point.
    summary
        Description in a few words.
    create
        Returns the engine. It is given what follows ``NAME:``, or the whole text if `takes` has
        recognised that; empty if there is nothing. If there is a `configuration`, an instance of it
        is the second argument.
    argument
        Word for what may follow ``NAME:``, such as ``FOLDER``; empty if nothing may.
    is_argument_required
        True if the name alone is not enough.
    takes
        Returns whether a text without a name, a path or an address, is for this engine.
    usage
        Words for error messages; empty: made from name and argument.
    requires
        Packages or programs that must be installed.
    files
        Returns the file or folder that its argument means, and loads no model. If the argument can
        be a name, it complains with an `AirhiltError` about one that stands for nothing.
    is_remote
        True if it asks a program elsewhere, which may answer differently another time: a replay
        takes its results from the record.
    probe
        Asks a program elsewhere one thing before a run, and raises an `AirhiltError` if it does not
        answer as it must; it is given what `create` is.
    configuration
        Model of its configuration, whose fields all have defaults; None: it has none. For decision
        engines, ``--assistant-config`` gives the values.
    """

    name: str
    summary: str
    create: Callable[..., T_co]
    argument: str = ""
    is_argument_required: bool = False
    takes: Callable[[str], bool] = lambda _: False
    usage: str = ""
    requires: tuple[Requirement, ...] = ()
    files: Callable[[str], Path] = Path
    is_remote: bool = False
    probe: Callable[[str], None] = lambda _: None
    configuration: type[BaseModel] | None = None

    def configured(self, given: Mapping[str, Any] | None) -> BaseModel | None:
        """Return its configuration with some values; None if it has none.

        Raises
        ------
        AirhiltError
            It has none but is given one, or a name or a value is wrong.
        """
        if self.configuration is not None:
            # Not at the top: the help of the command line does without pydantic.
            from airhilt.configuration import configured

            return configured(self.configuration, given or {}, f"configuration of {self.name!r}")
        if given is None:
            return None
        raise AirhiltError(
            f"configuration of {self.name!r}: it has none; expected none to be given"
        )

    def forms(self) -> str:
        """Return what to write on the command line."""
        if self.usage:
            return self.usage
        with_argument = f"{self.name}:{self.argument}"
        if not self.argument:
            return self.name
        return with_argument if self.is_argument_required else f"{self.name}, {with_argument}"

    def lacks(self) -> str:
        """Return how to get what is missing for it; empty if nothing is."""
        try:
            return next((each.remedy() for each in self.requires if not each.found()), "")
        except Exception as error:  # Requirements may be another package's code.
            return f"what it needs cannot be looked up: {type(error).__name__}: {error}"

    def accepts(self, argument: str) -> bool:
        """Return whether this may follow the name; empty stands for nothing."""
        return bool(self.argument) if argument else not self.is_argument_required


@dataclass(frozen=True)
class EngineFamily(Family, Generic[T]):
    """A `Family` whose members are each an `Engine`.

    Attributes
    ----------
    product
        Protocol that what each engine makes must be an instance of, as ``module:Name``.
    modality
        Modality of the workers that use its engines; empty: it is no family of a run.
    option
        Field of `airhilt.options.Options` that chooses the engine.
    help
        Help of that option.
    default
        Engine, or word in its place, unless another is named.
    words
        Words that the option takes in the place of an engine.
    needs
        Other options without which the option does nothing.
    sends
        What a run sends to a service that is an engine of it, in words.
    """

    attribute: str = "ENGINE"
    protocol: type[Engine[T]] = Engine
    product: str = "builtins:object"
    modality: str = ""
    option: str = ""
    help: str = ""
    default: str = ""
    words: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    sends: str = ""

    def create(self, text: str, configuration: Mapping[str, Any] | None = None) -> T:
        """Return the engine for what a person has written.

        Parameters
        ----------
        text
            ``NAME``, ``NAME:ARGUMENT``, a path, or an address.
        configuration
            Values of its configuration; None: the defaults.

        Raises
        ------
        AirhiltError
            No engine is meant, or more than one, or it cannot be made. The error is of the class
            that the family declares.
        """
        return self.make(*self.choose(text), configuration)

    def require_there(self, text: str) -> None:
        """Complain about a text that means no engine and none of `words`; no model is loaded.

        Raises
        ------
        AirhiltError
            No engine is meant, or more than one; or what the engine needs is not installed, or the
            file or folder that is its argument is not there.
        """
        if text in (self.default, *self.words):
            return
        engine, argument = self.choose(text, self.words)
        if lacks := engine.lacks():
            raise self.error(f"{self.word} {text!r}: it is not installed; expected {lacks}")
        engine.files(argument)
        is_path = engine.argument.startswith(("FILE", "FOLDER")) and "NAME" not in engine.argument
        if argument and is_path and not Path(argument).exists():
            raise self.error(
                f"{self.word} {text!r}: no such file or folder; expected {engine.forms()}"
            )

    def configuration_model(self, name: str) -> type[BaseModel]:
        """Return the model of the configuration of an engine.

        Raises
        ------
        AirhiltError
            There is no engine of that name, or it has no configuration.
        """
        engine, _ = self.choose(name)
        if engine.configuration is not None:
            return engine.configuration
        having = [each.name for each in self._loadable() if each.configuration is not None]
        raise self.error(
            f"{self.word} {name!r} has no configuration; expected one that has: "
            f"{', '.join(sorted(having))}"
        )

    def make(
        self, engine: Engine[T], argument: str, configuration: Mapping[str, Any] | None = None
    ) -> T:
        """Return what an engine makes of an argument, checked against the family's protocol.

        Parameters
        ----------
        configuration
            Values of its configuration; None: the defaults.

        Raises
        ------
        AirhiltError
            It cannot be made, or is no such thing.
        """
        text = f"{engine.name}:{argument}" if argument else engine.name
        configured = engine.configured(configuration)
        more = () if configured is None else (configured,)
        try:
            made = engine.create(argument, *more)
            product: type[Any] = resolve_name(self.product)
            fits = isinstance(made, product)
        except AirhiltError:
            raise
        except (Exception, SystemExit) as error:
            raise self.error(
                f"{self.word} {text!r} cannot be made: {type(error).__name__}: {error}"
            ) from error
        if not fits:
            lacks = ", ".join(missing(made, product))
            raise self.error(f"{self.word} {text!r}: what it makes, {made!r}, has no {lacks}")
        return made

    def choose(self, text: str, words: Sequence[str] = ()) -> tuple[Engine[T], str]:
        """Return the engine that a text asks for, and the argument for it.

        Parameters
        ----------
        words
            Words that could be there instead, for the error.

        Raises
        ------
        AirhiltError
            No engine is meant, or more than one, or one cannot say whether it is. The error is of
            the class that the family declares.
        """
        name, _, argument = text.partition(":")
        if name in self.names() and not is_service(text):
            engine: Engine[T] = self.load(name)
            if engine.accepts(argument):
                return engine, argument
            raise self.error(f"{self.word} {text!r}: expected {engine.forms()}")
        engines = self._loadable()
        takers = [engine for engine in engines if self._takes(engine, text)]
        if len(takers) == 1:
            return takers[0], text
        if takers:
            forms = " or ".join(f"{engine.name}:{text}" for engine in takers)
            raise self.error(f"{self.word} {text!r}: more than one can take it; expected {forms}")
        problem, meant = "there is none of that name", ""
        if text and Path(text).exists():
            problem = f"no {self.word} knows such files"
        else:
            alike = nearest(name, [*(each.name for each in engines if not each.usage), *words])
            meant = alike if "did you mean" in alike else ""
        every = [
            f"{engine.forms()} (needs {lacks})" if (lacks := engine.lacks()) else engine.forms()
            for engine in engines
        ]
        *others, last = [*every, *words]
        expected = f"{', '.join(others)}, or {last}" if others else last
        raise self.error(f"{self.word} {text!r}: {problem}; expected {expected}{meant}")

    def _takes(self, engine: Engine[T], text: str) -> bool:
        try:
            return bool(engine.takes(text))
        except (Exception, SystemExit) as error:
            raise self.error(
                f"{self.word} {engine.name!r} cannot say whether {text!r} is for it: "
                f"{type(error).__name__}: {error}"
            ) from error

    def _loadable(self) -> list[Engine[T]]:
        """Return the engines that can be loaded: by name, those with an address last."""
        found: list[Engine[T]] = []
        for name in self.names():
            with suppress(AirhiltError):  # Doctor says what is wrong with it.
                found.append(self.load(name))
        return sorted(found, key=lambda engine: bool(engine.usage))
