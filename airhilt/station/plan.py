"""``plan.json``: an experiment with people, its participants, trials and questions."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    JsonValue,
    Tag,
    ValidationError,
    model_validator,
)

from airhilt.errors import AirhiltError, all_problems, shown
from airhilt.options import options_of
from airhilt.scenario import loading
from airhilt.scenario.seats import seats_of
from airhilt.station.questionnaires import NASA_TLX, Items, Questionnaire
from airhilt.world.loading import load

Identifier = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]{0,19}$")]
Team = Annotated[tuple[Identifier, ...], Field(min_length=2, max_length=10)]
"""Participants who have the seats of one trial together, in the order of the seats."""
Participant = Annotated[
    Annotated[Identifier, Tag("identifier")] | Annotated[Team, Tag("team")],
    Discriminator(lambda given: "team" if isinstance(given, list | tuple) else "identifier"),
]
SETTLED = (
    "seat", "wait_for_seats", "out", "overwrite", "pace", "run_name", "endpoint", "attach",
    "pause", "nasa_tlx",
)  # fmt: skip
"""Options that the experiment itself gives."""


MOST_TRIALS = 1000
"""Greatest number of trials of a participant."""


class Trial(BaseModel):
    """One run of a participant, the same for all participants but for its position."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    name: str
    scenario: str
    conditions: dict[str, JsonValue]


class OwnQuestions(BaseModel):
    """Questions of a plan, by when they are asked."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    before: Items = Field(default=(), description="before the first trial")
    after_trial: Items = Field(default=(), description="after each trial, and after NASA-TLX")
    end: Items = Field(default=(), description="after the last trial")


class Plan(BaseModel):
    """An experiment: every participant has each scenario in each combination of the conditions.

    The order is that of a balanced Latin square, a row a participant. Where a trial has several
    seats, a row is that of a team.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    format: Literal[1] = 1
    participants: tuple[Participant, ...] = Field(
        min_length=1,
        max_length=1000,
        description="identifiers such as P01, no names of people; with seats a list of them for "
        "each team, in the order of the seats",
    )
    seat: str | None = Field(
        default=None, description="seat that participants have: tower, a unit, or a callsign"
    )
    seats: tuple[str, ...] | None = Field(
        default=None,
        min_length=2,
        max_length=10,
        description="in the place of seat: seats that the participants of a team have at once",
    )
    scenarios: tuple[str, ...] = Field(min_length=1, description="names, or JSON files")
    conditions: dict[str, tuple[JsonValue, ...]] = Field(
        default_factory=dict,
        description="values of options, such as assistant, snr_db and visibility_m",
    )
    options: dict[str, JsonValue] = Field(
        default_factory=dict, description="options that all trials have, as airhilt.run takes them"
    )
    break_after: int = Field(default=0, ge=0, description="trials between breaks; 0: no break")
    break_minutes: float = Field(default=5.0, gt=0.0, le=120.0, description="least time of a break")
    pause: bool = Field(default=False, description="let participants pause and slow the trials")
    nasa_tlx: bool = Field(default=True, description="ask NASA-TLX at the end of each trial")
    questions: OwnQuestions = Field(
        default_factory=OwnQuestions, description="more questions, on the page of the experiment"
    )

    @model_validator(mode="after")
    def _is_possible(self) -> Plan:
        self._require_a_seat_each()
        for name, values in self.conditions.items():
            if not values:
                raise ValueError(f"conditions/{name}: expected at least one value")
        for name in (*self.conditions, *self.options):
            if name in SETTLED:
                raise ValueError(f"{name}: the experiment gives it; expected another option")
        trials = math.prod(map(len, (self.scenarios, *self.conditions.values())))
        if trials > MOST_TRIALS:
            raise ValueError(f"found {trials:,} trials; expected at most {MOST_TRIALS:,}")
        return self

    def _require_a_seat_each(self) -> None:
        if (self.seat is None) is (self.seats is None):
            raise ValueError("expected either seat, of one participant, or seats, of a team")
        seats = self.seats or (self.seat,)
        if len(set(seats)) < len(seats):
            raise ValueError("seats: one is there twice")
        for one in self.participants:
            if isinstance(one, str) is (self.seats is not None):
                expected = "an identifier" if self.seats is None else "a list, for there are seats"
                raise ValueError(f"participants: found {shown(one)}; expected {expected}")
        for team in self.teams:
            if len(team) != len(seats):
                raise ValueError(
                    f"participants: found a team of {len(team)}, {', '.join(team)}; expected "
                    f"{len(seats)}, one for each seat"
                )
        if max(Counter(itertools.chain(*self.teams)).values()) > 1:
            raise ValueError("participants: one is there twice")

    @property
    def teams(self) -> tuple[tuple[str, ...], ...]:
        """Participants who have the same trials together: one each where there is one seat."""
        return tuple((one,) if isinstance(one, str) else one for one in self.participants)

    def team_of(self, participant: str) -> tuple[str, ...]:
        """Return the team of a participant.

        Raises
        ------
        AirhiltError
            There is no such participant.
        """
        for team in self.teams:
            if participant in team:
                return team
        raise AirhiltError(
            f"participant {participant!r}: not in the plan; expected one of "
            f"{', '.join(itertools.chain(*self.teams))}"
        )

    def seat_of(self, participant: str) -> str:
        """Return the seat of a participant, as the plan has it."""
        return self.all_seats[self.team_of(participant).index(participant)]

    @property
    def all_seats(self) -> tuple[str, ...]:
        """Seats of each trial, in the order of the participants of a team."""
        return self.seats or (str(self.seat),)

    def before(self) -> Questionnaire:
        """Return what is asked before the first trial; it may have no items."""
        return Questionnaire("before", self.questions.before)

    def after_trial(self) -> list[Questionnaire]:
        """Return what is asked after each trial, in this order."""
        own = Questionnaire("after_trial", self.questions.after_trial)
        return [NASA_TLX, own] if self.nasa_tlx else [own]

    def end(self) -> Questionnaire:
        """Return what is asked after the last trial; it may have no items."""
        return Questionnaire("end", self.questions.end)

    def trials(self) -> list[Trial]:
        """Return all trials, in the order of the file."""
        combinations = list(itertools.product(*self.conditions.values()))
        return [
            Trial(
                name=f"{Path(scenario).stem}-{number}",
                scenario=scenario,
                conditions=dict(zip(self.conditions, combination, strict=True)),
            )
            for scenario in self.scenarios
            for number, combination in enumerate(combinations, 1)
        ]

    def order_of(self, participant: str) -> list[Trial]:
        """Return the trials of a participant, in their order.

        Raises
        ------
        AirhiltError
            There is no such participant.
        """
        trials = self.trials()
        rows = balanced_latin_square(len(trials))
        row = rows[self.teams.index(self.team_of(participant)) % len(rows)]
        return [trials[index] for index in row]

    @property
    def balance(self) -> int:
        """Number of teams of which any multiple makes the order balanced."""
        return len(balanced_latin_square(len(self.trials())))

    def check(self) -> None:
        """Complain about a trial that cannot be run.

        Raises
        ------
        AirhiltError
            A scenario, the seat or an option is wrong.
        """
        for trial in self.trials():
            options_of({**self.options, **trial.conditions})
            seats = seats_of(self.all_seats, load(loading.find(trial.scenario)))
            if len(seats) < len(self.all_seats):
                raise AirhiltError(
                    f"seats: two of {', '.join(self.all_seats)} are the same seat in "
                    f"{trial.scenario}; expected another seat for each participant"
                )


def plan_of(document: Any, origin: str) -> Plan:
    """Return the plan that a JSON document holds; ``origin`` begins an error message.

    Raises
    ------
    AirhiltError
        It is not valid.
    """
    try:
        return Plan.model_validate(document)
    except ValidationError as error:
        raise AirhiltError(f"{origin}: {all_problems(error)}") from None


def balanced_latin_square(size: int) -> list[list[int]]:
    """Return rows of 0 to ``size`` - 1 in which each number follows each other equally often.

    There are ``size`` rows, twice as many if ``size`` is odd (Williams 1949, Aust. J. Chem. 2,
    149).
    """
    first = [0]
    for step in range(1, size):
        first.append((step + 1) // 2 if step % 2 else size - step // 2)
    rows = [[(number + shift) % size for number in first] for shift in range(size)]
    return rows if size % 2 == 0 else [*rows, *(row[::-1] for row in rows)]
