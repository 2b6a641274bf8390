"""Questions to a participant, each with a scale or a choice: those of a plan, and NASA-TLX."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StrictInt, StrictStr

from airhilt.errors import shown

Answer = StrictInt | Annotated[StrictStr, Field(max_length=200)]
Answers = dict[str, Answer]
"""Answers by the names of the items."""
ItemName = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}$")]
Question = Annotated[str, Field(min_length=1, max_length=400)]
Label = Annotated[str, Field(min_length=1, max_length=80)]


class Scale(BaseModel):
    """A question that is answered by a number, of which the page shows what both ends mean."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    type: Literal["scale"]
    name: ItemName = Field(description="name of its column")
    title: Label | None = Field(default=None, description="a word or two before the question")
    question: Question
    low: Label = Field(description="meaning of the first step")
    high: Label = Field(description="meaning of the last step")
    steps: int = Field(default=7, ge=2, le=101)
    first: int = Field(default=1, ge=-1000, le=1000, description="number of the first step")
    interval: int = Field(default=1, ge=1, le=100, description="from a step to the next one")

    def check(self, answer: Answer) -> None:
        """Complain about an answer that is no step.

        Raises
        ------
        ValueError
            It is none.
        """
        steps = range(self.first, self.first + self.steps * self.interval, self.interval)
        if answer not in steps:
            every = "" if self.interval == 1 else f" in steps of {self.interval}"
            raise ValueError(
                f"{self.name}: found {shown(answer)}; expected {steps[0]} to {steps[-1]}{every}"
            )


def _differ(choices: tuple[str, ...]) -> tuple[str, ...]:
    if len(set(choices)) < len(choices):
        raise ValueError("one choice is there twice")
    return choices


class Choice(BaseModel):
    """A question that is answered by one of a few texts."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    type: Literal["choice"]
    name: ItemName = Field(description="name of its column")
    title: Label | None = Field(default=None, description="a word or two before the question")
    question: Question
    choices: Annotated[
        tuple[Label, ...], Field(min_length=2, max_length=30), AfterValidator(_differ)
    ]

    def check(self, answer: Answer) -> None:
        """Complain about an answer that is no choice.

        Raises
        ------
        ValueError
            It is none.
        """
        if answer not in self.choices:
            raise ValueError(
                f"{self.name}: found {shown(answer)}; expected one of {', '.join(self.choices)}"
            )


Item = Annotated[Scale | Choice, Field(discriminator="type")]


def _have_own_names(items: tuple[Item, ...]) -> tuple[Item, ...]:
    names = [item.name for item in items]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"two items are called {name}; expected another name for one of them")
    return items


Items = Annotated[tuple[Item, ...], Field(max_length=50), AfterValidator(_have_own_names)]


class Questionnaire(NamedTuple):
    """Items that are answered together.

    Attributes
    ----------
    name
        Name that begins its columns and ends the names of the files with its answers.
    """

    name: str
    items: Sequence[Scale | Choice]

    def check(self, answers: Mapping[str, Answer]) -> None:
        """Refuse answers unless there is one to each item.

        Raises
        ------
        ValueError
            One is missing, is not asked for, or is not what its item takes.
        """
        for name in answers:
            if name not in {item.name for item in self.items}:
                raise ValueError(f"{shown(name)}: not asked")
        for item in self.items:
            if item.name not in answers:
                raise ValueError(f"{item.name}: not answered")
            item.check(answers[item.name])

    def document(self) -> dict[str, Any]:
        """Return it as a page is given it."""
        items = [item.model_dump(mode="json") for item in self.items]
        return {"name": self.name, "items": items}


def _of_tlx(name: str, question: str, ends: tuple[str, str] = ("Very low", "Very high")) -> Scale:
    return Scale(
        type="scale", name=name, title=name.replace("_", " ").capitalize(), question=question,
        low=ends[0], high=ends[1], steps=21, first=0, interval=5,
    )  # fmt: skip


NASA_TLX = Questionnaire(
    "nasa_tlx",
    (
        _of_tlx("mental_demand", "How mentally demanding was the task?"),
        _of_tlx("physical_demand", "How physically demanding was the task?"),
        _of_tlx("temporal_demand", "How hurried or rushed was the pace of the task?"),
        _of_tlx(
            "performance",
            "How successful were you in doing what you were asked to do?",
            ("Perfect", "Failure"),
        ),
        _of_tlx("effort", "How hard did you have to work to reach your level of performance?"),
        _of_tlx(
            "frustration", "How insecure, discouraged, irritated, stressed and annoyed were you?"
        ),
    ),
)
"""The six scales of NASA-TLX (Hart & Staveland 1988), as `NasaTlx` takes their answers."""
