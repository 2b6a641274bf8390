"""The modalities that an assistant is given, and what it cannot read without the others."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from airhilt.errors import WorkerError
from airhilt.messages import InputSpec
from airhilt.workers.pool import Participant

KEYS: Mapping[str, tuple[str, ...]] = {
    "adsb": ("adsb",),
    "asr": ("asr", "radio", "enhanced", "seat"),
    "vision": ("vision", "camera"),
}
"""First chunks of the keys of each modality: its results, and the sound or pictures behind them."""
NO_EVIDENCE = frozenset({"briefing", "status"})
"""First chunks of keys that tell an assistant of the run, and nothing of the traffic."""


def limited(worker: Participant, given: Collection[str]) -> Participant:
    """Return a worker that, if it decides, has inputs of the given modalities only.

    Equipment of the world and all other workers keep their inputs.

    Raises
    ------
    WorkerError
        Nothing of the traffic is left.
    """
    description = worker.description
    if description.modality != "decision":
        return worker
    inputs = inputs_given(description.engine or description.name, description.inputs, given)
    return replace(worker, description=description.model_copy(update={"inputs": inputs}))


def inputs_given(
    name: str, inputs: Sequence[InputSpec], given: Collection[str]
) -> tuple[InputSpec, ...]:
    """Return those of the inputs that belong to no modality, or to one that is given.

    Parameters
    ----------
    name
        Name of the assistant, for the error message.

    Raises
    ------
    WorkerError
        Nothing of the traffic is left.
    """
    withheld = {key for modality, keys in KEYS.items() if modality not in given for key in keys}
    left = tuple(each for each in inputs if _first(each) not in withheld)
    if len(left) < len(inputs) and all(_first(each) in NO_EVIDENCE for each in left):
        reads = "+".join(
            modality
            for modality, keys in KEYS.items()
            if any(_first(each) in keys for each in inputs)
        )
        raise WorkerError(
            f"--modalities {'+'.join(each for each in KEYS if each in given)}: assistant {name!r} "
            f"reads {reads}, so nothing is left to it; expected some of that"
        )
    return left


def _first(wanted: InputSpec) -> str:
    return wanted.key.partition("/")[0]
