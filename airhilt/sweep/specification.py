"""``sweep.json``: what a sweep runs. The flags of the command line only abbreviate it."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue, ValidationError

from airhilt.errors import AirhiltError
from airhilt.scenario.problems import problems_of
from airhilt.sweep.axes import Interval, Values

ParameterPath = Annotated[str, Field(min_length=1)]


class Sample(BaseModel):
    """Points drawn from a box of parameters, in the place of a grid of them."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    method: Literal["latin_hypercube", "sobol"] = Field(
        description="latin_hypercube: each parameter evenly covered; sobol: a scrambled Sobol "
        "sequence, whose count is best a power of 2 (both of scipy.stats.qmc)"
    )
    count: int = Field(ge=1, le=1_000_000, description="number of points")
    seed: int = Field(default=0, ge=0, description="seed of the points")
    intervals: dict[ParameterPath, Interval] = Field(
        min_length=1, description="interval of each parameter, by its path"
    )

    def points(self) -> list[dict[str, float]]:
        """Return the points: a value of each parameter, by its path.

        The same sample gives the same points, and a longer Sobol sequence begins with the shorter
        one.
        """
        from scipy.stats import qmc

        size = len(self.intervals)
        if self.method == "sobol":
            bits = max(self.count - 1, 1).bit_length()
            shares = qmc.Sobol(size, rng=self.seed).random_base2(bits)[: self.count]
        else:
            shares = qmc.LatinHypercube(size, rng=self.seed).random(self.count)
        return [
            {
                path: interval.at(float(share))
                for (path, interval), share in zip(self.intervals.items(), row, strict=True)
            }
            for row in shares
        ]


class Specification(BaseModel):
    """All runs of a sweep: every scenario with every seed and every combination of the axes.

    A path names an option of a run (``snr_db``, ``visibility_m``, ``assistant``, ``latency``), a
    setting of the assistant (``assistant.tau_asr``), or a value of the scenario
    (``actors.AAL123.initial.distance_m``).
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    format: Literal[1] = 1
    scenarios: tuple[str, ...] = Field(
        min_length=1, description="names, patterns such as s01a_*, or JSON files"
    )
    seeds: Values = Field(default=(0,), description="seeds of each combination")
    options: dict[str, JsonValue] = Field(
        default_factory=dict, description="options that all runs have, as airhilt.run takes them"
    )
    axes: dict[ParameterPath, Values] = Field(
        default_factory=dict, description="values of each parameter of the grid, by its path"
    )
    sample: Sample | None = Field(
        default=None, description="points drawn from intervals; each meets the whole grid"
    )


def first_seeds(count: int) -> dict[str, int]:
    """Return the seeds 0, 1 ... of a number of them, as a sweep file has them."""
    if count < 1:
        raise AirhiltError(f"seeds {count}: expected at least 1, for the seed 0")
    return {"from": 0, "to": count - 1, "step": 1}


def specification_of(document: Any, origin: str) -> Specification:
    """Return the specification that a JSON document holds; ``origin`` begins an error message.

    Raises
    ------
    AirhiltError
        It is not valid.
    """
    try:
        return Specification.model_validate(document)
    except ValidationError as error:
        problems = problems_of(error, Specification)
        raise AirhiltError("\n".join(f"{origin}: {problem}" for problem in problems)) from None
