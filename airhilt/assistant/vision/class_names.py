"""Names that detectors of other people give their classes, and what AIRHILT calls them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from pydantic import BaseModel, ConfigDict

from airhilt.errors import VisionError
from airhilt.host.library import nearest
from airhilt.messages import VisibleClass, WorkerDescription

SYNONYMS: Mapping[VisibleClass, str] = {
    "airplane": "airplane aeroplane aircraft plane airliner jet",
    "truck": "truck car bus lorry van vehicle pickup",
    "bird": "bird goose gull flock",
    "deer": "deer",
    "coyote": "coyote",
}
"""Names of classes, separated by blanks, by what AIRHILT calls them."""
COCO = tuple(
    re.split(
        r",\s*",
        """person, bicycle, car, motorcycle, airplane, bus, train, truck, boat, traffic light,
        fire hydrant, stop sign, parking meter, bench, bird, cat, dog, horse, sheep, cow, elephant,
        bear, zebra, giraffe, backpack, umbrella, handbag, tie, suitcase, frisbee, skis, snowboard,
        sports ball, kite, baseball bat, baseball glove, skateboard, surfboard, tennis racket,
        bottle, wine glass, cup, fork, knife, spoon, bowl, banana, apple, sandwich, orange,
        broccoli, carrot, hot dog, pizza, donut, cake, chair, couch, potted plant, bed,
        dining table, toilet, tv, laptop, mouse, remote, keyboard, cell phone, microwave, oven,
        toaster, sink, refrigerator, book, clock, vase, scissors, teddy bear, hair drier,
        toothbrush""",
    )
)
"""The 80 classes of COCO, in the order in which most models number them."""
_UNUSED_IDS = (12, 26, 29, 30, 45, 66, 68, 69, 71, 83)
COCO_BY_ID: Mapping[int, str] = dict(
    zip((number for number in range(1, 91) if number not in _UNUSED_IDS), COCO, strict=True)
)
"""The same by their category ids, from 1 to 90."""
_MEANT = {synonym: label for label, synonyms in SYNONYMS.items() for synonym in synonyms.split()}


class DetectorClasses(BaseModel):
    """Classes of a detector that a person has named, in the place of `SYNONYMS`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    classes: dict[str, VisibleClass] = {}


@runtime_checkable
class HasClassMap(Protocol):
    """Part of a detector whose model has class names of its own."""

    @property
    def classes(self) -> ClassMap:
        """Labels of the classes of its model."""


@dataclass(frozen=True)
class ClassMap:
    """Labels of the classes of a model.

    Attributes
    ----------
    labels
        Labels by the numbers of the classes that count.
    names
        Names in the model, by number.
    """

    labels: Mapping[int, VisibleClass]
    names: Mapping[int, str]

    @classmethod
    def of(
        cls, names: Mapping[int, str], given: Mapping[str, VisibleClass], subject: str
    ) -> ClassMap:
        """Return that of a model.

        Parameters
        ----------
        given
            Labels by names of classes, which go before `SYNONYMS`.

        Raises
        ------
        VisionError
            The model has no class of a given name, or none that counts.
        """
        known = {_plain(name) for name in names.values()}
        for name in given:
            if _plain(name) not in known:
                raise VisionError(
                    f"--detector-classes {name}=...: {subject} has no such class; expected one of "
                    f"{_first(names.values())}{nearest(_plain(name), sorted(known))}"
                )
        meant = _MEANT | {_plain(name): label for name, label in given.items()}
        labels = {
            number: meant[_plain(name)] for number, name in names.items() if _plain(name) in meant
        }
        if not labels:
            raise VisionError(
                f"{subject}: it knows {len(names)} classes ({_first(names.values())}); expected "
                f"at least one of {', '.join(_MEANT)}, or --detector-classes NAME=airplane"
            )
        return cls(labels, names)

    @property
    def dropped(self) -> tuple[str, ...]:
        """Names of the classes whose findings are dropped."""
        return tuple(name for number, name in self.names.items() if number not in self.labels)

    @property
    def configuration(self) -> dict[str, object]:
        """Part of the configuration of a worker that says which classes it tells and drops."""
        kept = {self.names[number]: label for number, label in self.labels.items()}
        return {"classes": kept, "dropped_classes": list(self.dropped)}


def notice_of(description: WorkerDescription) -> str:
    """Return a sentence on the classes of a vision worker; empty if its model has no others."""
    kept = description.configuration.get("classes", {})
    dropped = description.configuration.get("dropped_classes", [])
    if description.modality != "vision" or not kept:
        return ""
    pairs = kept.items()
    told = ", ".join(name if name == label else f"{name} as {label}" for name, label in pairs)
    rest = f"; drops {len(dropped)} classes: {_first(dropped)}" if dropped else ""
    return f"{description.name} tells {told}{rest}"


def _plain(name: str) -> str:
    return name.strip().lower().replace("_", " ").replace("-", " ")


def _first(names: Iterable[object]) -> str:
    every = [str(name) for name in names]
    return ", ".join(every[:8]) + ("..." if len(every) > 8 else "")
