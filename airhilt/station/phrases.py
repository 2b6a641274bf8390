"""Phrases that a person at a seat is offered, for the situation that the page of the seat shows."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from airhilt.phraseology import Instruction, parse_call
from airhilt.phraseology.say import (
    speak_altitude,
    speak_callsign,
    speak_heading,
    speak_instruction,
    speak_readback,
    speak_runway,
    speak_say_again,
)
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE

Name = Annotated[str, Field(max_length=40, pattern=r"^[A-Za-z0-9][A-Za-z0-9 _-]*$")]
STEP_FT = 1000.0
"""Step of the levels that are offered, in ft."""
TURN_DEG = 30.0
"""Angle of the turns that are offered, in degrees."""
TRANSITION_FT = 18_000.0
"""Altitude from which a label is a flight level, in ft (United States)."""
FINAL_NM = 15.0
"""Distance from the airport, in NM, within which an aircraft may be on its approach."""
FINAL_FT = FINAL_NM * NAUTICAL_MILE * math.tan(3.0 * DEGREE) / FOOT
"""Height above the airport, in ft, below which it may be: that of the usual glide path of 3 degrees
at `FINAL_NM`."""
Phrase = tuple[str, str]
"""Label and words."""


class Situation(BaseModel):
    """Speaker and addressee, as far as the page knows them."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    speaker: Literal["unit", "aircraft", "vehicle"]
    callsign: Name | None = Field(description="of the crew that speaks or is spoken to")
    style: Literal["faa", "icao"] = "faa"
    category: Literal["aircraft", "vehicle"] = "aircraft"
    on_ground: bool = False
    runway: Annotated[str, Field(pattern=r"^[0-9]{2}[LCR]?$")] | None = None
    altitude_ft: float | None = Field(default=None, ge=-2000.0, le=60_000.0)
    height_ft: float | None = Field(
        default=None, ge=-20_000.0, le=60_000.0, description="above the airport"
    )
    distance_nm: float | None = Field(default=None, ge=0.0, description="from the airport")
    heading_deg: float | None = Field(default=None, ge=0.0, le=360.0, description="magnetic")
    heard: str = Field(default="", max_length=600, description="last call to the own crew")

    @property
    def may_be_landing(self) -> bool:
        """True if the aircraft is low and near enough to be on its approach, as far as is known."""
        if self.on_ground or self.height_ft is None or self.distance_nm is None:
            return False
        return self.height_ft <= FINAL_FT and self.distance_nm <= FINAL_NM


def offered(situation: Situation) -> list[dict[str, str]]:
    """Return the phrases for a situation: a short label, and the words of the call."""
    if situation.callsign is None:
        return []
    make = _of_unit if situation.speaker == "unit" else _of_crew
    return [{"label": label, "text": text} for label, text in make(situation, situation.callsign)]


# --- a controller ---------------------------------------------------------------------------


def _of_unit(situation: Situation, callsign: str) -> Iterator[Phrase]:
    for label, instruction in _instructions(situation):
        yield label, speak_instruction(callsign, instruction, situation.style)
    yield "Say again", f"{speak_callsign(callsign, situation.style)}, say again."


def _instructions(situation: Situation) -> Iterator[tuple[str, Instruction]]:
    runway = situation.runway
    if situation.category == "vehicle":
        yield "Hold position", Instruction("hold_position")
        if runway is not None:
            yield f"Hold short of {runway}", Instruction("hold_short", runway=runway)
            yield f"Cross {runway}", Instruction("cross", runway=runway)
            yield f"Proceed onto {runway}", Instruction("proceed", runway=runway)
            yield f"Vacate {runway}", Instruction("vacate", runway=runway)
    elif situation.on_ground:
        yield "Hold position", Instruction("hold_position")
        if runway is not None:
            yield f"Hold short of {runway}", Instruction("hold_short", runway=runway)
            yield f"Line up {runway}", Instruction("line_up", runway=runway)
            yield f"Cleared for takeoff {runway}", Instruction("cleared_for_takeoff", runway=runway)
            yield "Cancel takeoff", Instruction("cancel_takeoff")
            yield f"Cross {runway}", Instruction("cross", runway=runway)
    else:
        yield from _airborne(situation)


def _airborne(situation: Situation) -> Iterator[tuple[str, Instruction]]:
    runway, altitude_ft, heading_deg = (
        situation.runway, situation.altitude_ft, situation.heading_deg,
    )  # fmt: skip
    if runway is not None and situation.may_be_landing:
        yield f"Cleared to land {runway}", Instruction("cleared_to_land", runway=runway)
        yield "Go around", Instruction("go_around")
        yield "Continue approach", Instruction("continue_approach", runway=runway)
    if altitude_ft is not None:
        level_ft = round(altitude_ft / STEP_FT) * STEP_FT
        for sense, to_ft in (("climb", level_ft + STEP_FT), ("descend", level_ft - STEP_FT)):
            if to_ft >= STEP_FT:
                yield (
                    f"{sense.capitalize()} {_level(to_ft)}",
                    Instruction("altitude", sense=sense, altitude_ft=to_ft),  # type: ignore[arg-type]
                )
    if heading_deg is not None:
        for turn, by_deg in (("left", -TURN_DEG), ("right", TURN_DEG)):
            to_deg = round((heading_deg + by_deg) / 10.0) * 10.0 % 360.0 or 360.0
            yield (
                f"Turn {turn} {to_deg:03.0f}",
                Instruction("heading", turn=turn, heading_deg=to_deg),  # type: ignore[arg-type]
            )


def _level(feet: float) -> str:
    return f"FL{feet / 100.0:.0f}" if feet >= TRANSITION_FT else f"{feet:,.0f} ft"


# --- a crew or a driver ---------------------------------------------------------------------


def _of_crew(situation: Situation, callsign: str) -> Iterator[Phrase]:
    style, own = situation.style, speak_callsign(callsign, situation.style)
    told = parse_call(situation.heard, [callsign]).instructions
    if told:
        yield "Read back", speak_readback(callsign, told, style)
        yield "Unable", f"Unable, {own}."
    if situation.heard:
        yield "Roger", speak_readback(callsign, [], style)
    yield "Say again", speak_say_again(callsign, style)
    if situation.speaker == "aircraft" and not situation.on_ground:
        if situation.may_be_landing:
            yield "Going around", f"{own}, going around."
        if situation.altitude_ft is not None:
            level_ft = round(situation.altitude_ft / 100.0) * 100.0
            yield "Report level", f"{own}, {speak_altitude(level_ft, style)}."
        if situation.heading_deg is not None:
            yield "Report heading", f"{own}, heading {speak_heading(situation.heading_deg, style)}."
    if situation.speaker == "vehicle" or situation.on_ground:
        yield "Holding position", f"{own}, holding position."
        if situation.runway is not None:
            runway = speak_runway(situation.runway, style)
            yield f"Holding short of {situation.runway}", f"{own}, holding short of {runway}."
            yield f"{situation.runway} vacated", f"{own}, {runway} vacated."
