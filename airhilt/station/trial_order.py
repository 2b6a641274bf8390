"""The order of the trials of each participant of an experiment: a balanced Latin square."""

from __future__ import annotations

from airhilt.station.plan import Plan, Trial


def order_of(plan: Plan, participant: str) -> list[Trial]:
    """Return the trials of a participant, in their order.

    Raises
    ------
    AirhiltError
        There is no such participant.
    """
    trials = plan.trials()
    rows = balanced_latin_square(len(trials))
    row = rows[plan.teams.index(plan.team_of(participant)) % len(rows)]
    return [trials[index] for index in row]


def balance_of(plan: Plan) -> int:
    """Return the number of teams of which any multiple makes the order balanced."""
    return len(balanced_latin_square(len(plan.trials())))


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
