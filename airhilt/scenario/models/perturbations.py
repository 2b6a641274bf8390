"""Perturbations of a scenario: numbers to which a seeded draw is added."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.quantities import Number
from airhilt.scenario.models.base import Model

GREATEST = 1e6
"""Greatest standard deviation and greatest limit of a draw, in the unit of the number."""


class Normal(Model):
    """Normal distribution around zero; draws beyond ``limit`` either side are set to the limit."""

    type: Literal["normal"]
    sigma: Number = Field(gt=0.0, le=GREATEST)
    limit: Number = Field(gt=0.0, le=GREATEST)


class Uniform(Model):
    """Uniform distribution between ``-limit`` and ``limit``."""

    type: Literal["uniform"]
    limit: Number = Field(gt=0.0, le=GREATEST)


class Perturbation(Model):
    """Number in this file to which a seeded draw is added.

    ``path`` leads to it from the top; list entries are named by callsign, id or name, or by index:
    ``actors/AAL123/initial/cas_kt``.
    """

    path: str = Field(min_length=1, max_length=200)
    distribution: Annotated[Normal | Uniform, Field(discriminator="type")]
