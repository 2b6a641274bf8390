"""Response models: how soon people respond to what tells them to act, and whether they do.

`RESPONSE_MODELS` is the table. Crews, drivers and controllers each have shares of their own for
every `Channel`. A number without a source is called assumed.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from airhilt.quantities import Number, Share
from airhilt.scenario.models.base import Model

Channel = Literal["ra", "assistant", "controller"]
"""Source of what somebody is told to do: a resolution advisory or another alert of equipment, an
advisory of the assistant, or an urgent call of a controller."""


ResponseModelName = Literal["ideal", "icao", "observed"]
"""Name of a response model."""


class Responses(Model):
    """Responses on one channel: a lognormal delay, and the shares of those who do not do as told.

    The rest does as told, in time. So do those who are too slow or go the wrong way, where they
    are told anything but to climb or to descend.
    """

    median_s: Number = Field(ge=0.0, le=120.0, description="of a first response")
    sigma: Number = Field(default=0.3, ge=0.0, le=2.0, description="of the delay's logarithm")
    no_response: Share = Field(default=0.0, description="share that does nothing")
    late: Share = Field(default=0.0, description="share that does as told, but late")
    weak: Share = Field(default=0.0, description="share that climbs or descends too slowly")
    opposite: Share = Field(default=0.0, description="share that climbs in place of descending")
    late_factor: Number = Field(
        default=2.0, ge=1.0, le=20.0, description="delay of a late response, as a multiple"
    )
    rate_factor: Share = Field(
        default=0.5, description="vertical rate of a weak response, as a part of the one told"
    )

    @model_validator(mode="after")
    def _shares_are_parts_of_one(self) -> Responses:
        total = self.no_response + self.late + self.weak + self.opposite
        if total > 1.0 + 1e-9:
            raise ValueError(
                f"no_response, late, weak and opposite add up to {total:g}; expected at most 1"
            )
        return self

    def with_compliance(self, compliance: float) -> Responses:
        """Return the responses of somebody who responds at all with a given probability."""
        responding = 1.0 - self.no_response
        scale = compliance / responding if responding else 0.0
        changed = {name: getattr(self, name) * scale for name in ("late", "weak", "opposite")}
        return self.model_copy(update={"no_response": 1.0 - compliance, **changed})


class Channels(Model):
    """Responses of people in one role; null: as to an advisory of the assistant."""

    assistant: Responses
    ra: Responses | None = None
    controller: Responses | None = None

    def of(self, channel: Channel) -> Responses:
        """Return the responses on a channel."""
        found: Responses | None = getattr(self, channel)
        return found or self.assistant


class ResponseModel(Model):
    """Response model: the responses of crews, drivers and controllers."""

    crews: Channels
    drivers: Channels
    controllers: Responses
    """To advisories and to the conflict alert alike."""


def _is_named(given: object) -> Literal["name", "model"]:
    return "model" if isinstance(given, Mapping | ResponseModel) else "name"


NamedOrOwnModel = Annotated[
    Annotated[ResponseModelName, Tag("name")] | Annotated[ResponseModel, Tag("model")],
    Discriminator(_is_named),
]
"""Name of a response model, or a model of one's own."""

PROMPT_S = 1.0
"""Delay of people who respond at once, in s: assumed, a simple reaction with a movement."""
FIRST_RESPONSE_S = 5.0
"""Delay of a first response to a resolution advisory, in s, in the standard pilot model (ICAO Annex
10, volume IV, 4.4.2.6). For an assistant: assumed the same."""
CALL_S = 2.0
"""Delay of what a crew does after a call, in s: assumed, that of scripted commands."""
DRIVER_S = 2.5
"""Delay of a driver, in s: brake reaction time for design (AASHTO, A Policy on Geometric Design of
Highways and Streets, 3.2.2)."""
CONTROLLER_S = 4.0
"""Median delay of a tower controller, in s. Its 95th percentile is 7 s, with `CONTROLLER_SIGMA`:
Kopald, Smith and Stevens (Proc. HFES 56, 2012, 2040) found a tail of 13 s, "almost twice" that of
earlier studies. That the tail is the 95th percentile is assumed."""
SLOW_CONTROLLER_S = 7.3
"""Median delay of a tower controller whose 95th percentile is 13 s: Kopald, Smith and Stevens."""
CONTROLLER_SIGMA = 0.35
"""Sigma of the delays of controllers: assumed."""

AT_ONCE = Responses(median_s=PROMPT_S, sigma=0.0)
OBSERVED_RA = Responses(
    median_s=FIRST_RESPONSE_S, no_response=0.16, late=0.11, weak=0.11, opposite=0.24
)
"""0.38 as commanded (EUROCONTROL, assessment of pilot compliance with TCAS RAs, 2020, strict
method). 0.60 followed in all (Aerospace 10(11), 2023, 952: 80,955 encounters), so 0.22 late or
weak; that both are equal is assumed. 0.24 in the opposite direction (Kuchar and Drumm, Lincoln
Laboratory Journal 16(2), 2007); the rest does nothing."""
OBSERVED_ASSISTANT = Responses(
    median_s=FIRST_RESPONSE_S, no_response=0.35, late=0.11, weak=0.11, opposite=0.05
)
"""Assumed, because nobody has flown with such an assistant: followed as often as a resolution
advisory, but a spoken level is taken for its opposite more rarely than a rate on a display."""
OBSERVED_CALL = Responses(median_s=CALL_S, no_response=0.02, late=0.10)
"""Assumed. What a crew mishears is no matter of this model: see docs/radio.md."""

RESPONSE_MODELS: Mapping[ResponseModelName, ResponseModel] = {
    "ideal": ResponseModel(
        crews=Channels(assistant=AT_ONCE), drivers=Channels(assistant=AT_ONCE), controllers=AT_ONCE
    ),
    "icao": ResponseModel(
        crews=Channels(
            assistant=Responses(median_s=FIRST_RESPONSE_S), controller=Responses(median_s=CALL_S)
        ),
        drivers=Channels(
            assistant=Responses(median_s=DRIVER_S), controller=Responses(median_s=CALL_S)
        ),
        controllers=Responses(median_s=CONTROLLER_S, sigma=CONTROLLER_SIGMA),
    ),
    "observed": ResponseModel(
        crews=Channels(assistant=OBSERVED_ASSISTANT, ra=OBSERVED_RA, controller=OBSERVED_CALL),
        drivers=Channels(
            assistant=Responses(median_s=DRIVER_S, no_response=0.10, late=0.15),
            controller=OBSERVED_CALL,
        ),
        controllers=Responses(median_s=SLOW_CONTROLLER_S, sigma=CONTROLLER_SIGMA, no_response=0.10),
    ),
}
"""Response models by name. ``ideal`` and ``icao`` obey always. The shares of drivers and of
controllers in ``observed`` are assumed."""
