"""The engines that a run uses, whether they ask a program elsewhere, and what that is sent."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

from airhilt.engine_families import ASSISTANTS, FAMILIES
from airhilt.engines import Engine, EngineFamily
from airhilt.errors import AirhiltError
from airhilt.host.services import is_elsewhere, is_service
from airhilt.messages import Modality
from airhilt.options import Options
from airhilt.workers.pool import Participant


class UsedEngine(NamedTuple):
    """An engine with its family and its argument."""

    family: EngineFamily[Any]
    engine: Engine[Any]
    argument: str


def engines_of(options: Options, modalities: Collection[str]) -> Iterator[UsedEngine]:
    """Yield the engines of the reference workers of some modalities.

    One that is not installed is left out: a replay takes its results from the record.
    """
    for family in FAMILIES:
        text = getattr(options, family.option)
        if family.modality in modalities and text not in family.words:
            with suppress(AirhiltError):
                yield UsedEngine(family, *family.choose(text))


def engines_in_use(
    options: Options, equipment: Iterable[str], workers: Iterable[Participant]
) -> list[UsedEngine]:
    """Return the engines of a run, whose options name its assistant, and of its equipment."""
    does: set[str] = {each.description.modality for each in workers if each.where == "in process"}
    if options.speech:
        does.add("tts")  # Crews and controllers speak with it, too.
    used = list(engines_of(options, does))
    for name in equipment:
        with suppress(AirhiltError):
            used.append(UsedEngine(ASSISTANTS, *ASSISTANTS.choose(name)))
    return used


def is_remote(options: Options, modality: Modality) -> bool:
    """Return whether the reference worker of a modality asks a program elsewhere."""
    return any(each.engine.is_remote for each in engines_of(options, (modality,)))


def is_of_user(options: Options, modality: Modality) -> bool:
    """Return whether a modality has an engine of another package, or asks a program elsewhere."""
    return any(
        each.engine.is_remote or not each.family.is_own(each.engine.name)
        for each in engines_of(options, (modality,))
    )


def is_own_engine(name: str) -> bool:
    """Return whether a decision engine of that name comes with AIRHILT; empty names none.

    The one that asks a service does not count: the service is the user's.
    """
    return name != "http" and ASSISTANTS.is_own(name)


def other_machines(options: Options, engines: Sequence[UsedEngine]) -> Iterator[str]:
    """Yield a sentence for each service in use that is not on this machine."""
    sent = [(each.family.sends, each.argument) for each in engines if is_service(each.argument)]
    if options.llm is not None and any(each.family.modality == "decision" for each in engines):
        asked = "radio calls, tracks and advisories" if options.assistant == "llm" else "advisories"
        sent.append((asked, options.llm))
    for what, url in sent:
        if is_elsewhere(url):
            yield f"this run sends {what} to another machine: {url}"
