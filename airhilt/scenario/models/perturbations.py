"""Perturbations of a scenario: numbers to which a seeded draw is added."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.scenario.models.base import Model


class Normal(Model):
    """Normal distribution around zero; draws beyond ``limit`` either side are set to the limit."""

    type: Literal["normal"]
    sigma: float = Field(gt=0.0)
    limit: float = Field(gt=0.0)


class Uniform(Model):
    """Uniform distribution between ``-limit`` and ``limit``."""

    type: Literal["uniform"]
    limit: float = Field(gt=0.0)


class Perturbation(Model):
    """Number in this file to which a seeded draw is added.

    ``path`` leads to it from the top; list entries are named by callsign, id or name, or by index:
    ``actors/AAL123/initial/cas_kt``.
    """

    path: str = Field(min_length=1)
    distribution: Annotated[Normal | Uniform, Field(discriminator="type")]
