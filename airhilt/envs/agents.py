"""Agents of a run: what each perceives, and what becomes of the manoeuvres that it chooses."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from airhilt.cosim.briefing import seat_equipment
from airhilt.cosim.setup import Setup
from airhilt.engine_families import EXTERNAL
from airhilt.envs.manoeuvres import Manoeuvre
from airhilt.envs.perception import Perception
from airhilt.errors import AirhiltError, shown
from airhilt.messages import (
    ActorCommand,
    AdsbReport,
    Advisory,
    AgreeToUses,
    CockpitInstruments,
    Evidence,
    Message,
    SayText,
    SeatAct,
    SeatAction,
    SeatState,
    Severity,
    TakeSeat,
    Transcript,
    key_chunk,
)
from airhilt.phraseology.say import speak_instruction
from airhilt.scenario import Scenario
from airhilt.scenario.models import AircraftSpec
from airhilt.scenario.seats import possible_seats, without_roles
from airhilt.sensors.radio.stations import Stations
from airhilt.station.audiences import audience_of, sees

ASSISTANT = "assistant"
"""Name of the agent that is the assistant."""
Acts = Iterator[tuple[str, Message]]
"""Keys and messages."""


class Agent(ABC):
    """An agent in a run.

    Attributes
    ----------
    name
        ``assistant``, the name of a unit, or a callsign.
    aircraft
        Callsigns of the aircraft whose manoeuvres it chooses.
    perception
        What it has perceived.
    """

    def __init__(
        self, name: str, aircraft: Sequence[str], setup: Setup, perception: Perception
    ) -> None:
        self.name = name
        self.aircraft = tuple(aircraft)
        self.perception = perception
        self._style = setup.scenario.radio.phraseology

    def begin(self) -> Acts:
        """Yield what it says before anything else."""
        yield from ()

    @abstractmethod
    def perceives(self, key: str, message: Message) -> bool:
        """Return whether it could know of a message."""

    def choose(self, callsign: str, manoeuvre: Manoeuvre) -> Acts:
        """Yield what it says so that an aircraft flies a manoeuvre; nothing before its report."""
        report = self.perception.reports.get(callsign)
        if report is not None and report.altitude_ft is not None:
            yield self._act(callsign, manoeuvre, report.altitude_ft)

    @abstractmethod
    def _act(
        self, callsign: str, manoeuvre: Manoeuvre, altitude_ft: float
    ) -> tuple[str, Message]: ...


class Assistant(Agent):
    """The assistant: it gets ADS-B reports and transcripts, and gives advisories to crews."""

    def __init__(
        self, name: str, aircraft: Sequence[str], setup: Setup, perception: Perception
    ) -> None:
        super().__init__(name, aircraft, setup, perception)
        self._revisions = dict.fromkeys(aircraft, -1)

    def perceives(self, key: str, message: Message) -> bool:  # noqa: ARG002
        """Return whether it could know of a message."""
        return isinstance(message, AdsbReport | Transcript)

    def _act(self, callsign: str, manoeuvre: Manoeuvre, altitude_ft: float) -> tuple[str, Advisory]:
        self._revisions[callsign] += 1
        instruction = manoeuvre.instruction(altitude_ft)
        advisory = Advisory(
            id=f"agent-{callsign}",
            revision=self._revisions[callsign],
            recipient=callsign,
            recipients=(callsign,),
            kind="loss_of_separation",
            severity=Severity.WARNING,
            traffic=tuple(self.perception.reports),
            message=speak_instruction(callsign, instruction, self._style),
            recommendation=manoeuvre.recommendation(altitude_ft),
            evidence=Evidence(sources=("adsb",)),
            t_ready_ns=self.perception.heard_ns,
        )
        return f"advisory/{callsign}", advisory


class SeatedAgent(Agent):
    """An agent that perceives what the person at its seat would be shown and hear."""

    def __init__(
        self, name: str, aircraft: Sequence[str], setup: Setup, perception: Perception
    ) -> None:
        super().__init__(name, aircraft, setup, perception)
        self._stations = Stations(setup.actors, setup.site, setup.scenario)
        frequencies_khz = self._stations.selectable(name)
        self._state = SeatState(
            seat=name,
            **seat_equipment(name, setup.scenario),
            frequencies_khz=frequencies_khz,
            tuned_khz=frequencies_khz,
            recogniser="none",
            voice_is_recorded=False,
        )

    def perceives(self, key: str, message: Message) -> bool:
        """Return whether it could know of a message."""
        match message:
            case AdsbReport() | Transcript():
                return sees(self._state, audience_of(key, message))
            case CockpitInstruments(callsign=callsign):
                return callsign == self.name
        return False


class Controller(SeatedAgent):
    """A controller: it gives instructions to crews by radio, in words."""

    def begin(self) -> Acts:
        """Take the seat."""
        yield self._do(TakeSeat())
        yield self._do(AgreeToUses(uses=("words",)))

    def _act(self, callsign: str, manoeuvre: Manoeuvre, altitude_ft: float) -> tuple[str, Message]:
        words = speak_instruction(callsign, manoeuvre.instruction(altitude_ft), self._style)
        return self._do(SayText(text=words, frequency_khz=self._stations.frequency_of(callsign)))

    def _do(self, act: SeatAct) -> tuple[str, SeatAction]:
        return f"seat/{key_chunk(self.name)}/do", SeatAction(holder="agent", act=act)


class Pilot(SeatedAgent):
    """A pilot: it flies its own aircraft by commands. Its crew speaks on the radio as before."""

    def _act(
        self, callsign: str, manoeuvre: Manoeuvre, altitude_ft: float
    ) -> tuple[str, ActorCommand]:
        return f"command/{callsign}", ActorCommand(command=manoeuvre.command(altitude_ft))


def named(names: Sequence[str], scenario: Scenario) -> tuple[str, ...]:
    """Return the names of agents in full: a unit may be called tower.

    Raises
    ------
    AirhiltError
        There is no such agent in the scenario.
    """
    seats = possible_seats(scenario)
    full = without_roles(names, scenario.radio.controller, seats)
    flown = aircraft_of(scenario)
    vehicles = {one.callsign for one in scenario.actors} - set(flown)
    known = (ASSISTANT, *flown, *(seat for seat in seats if seat not in (*flown, *vehicles)))
    for name in full:
        if name not in known:
            raise AirhiltError(
                f"agent {shown(name)}: {scenario.name!r} has none of that name; expected tower, or "
                f"one of {', '.join(known)}"
            )
    return full


def aircraft_of(scenario: Scenario) -> tuple[str, ...]:
    """Return the callsigns of the aircraft that controllers expect: they are in the briefing."""
    return tuple(
        one.callsign for one in scenario.actors if isinstance(one, AircraftSpec) and one.on_roster
    )


def options_for(names: Sequence[str], scenario: Scenario) -> dict[str, Any]:
    """Return the options of a run by which agents take part in it."""
    flown = aircraft_of(scenario)
    units = tuple(name for name in names if name != ASSISTANT and name not in flown)
    return {
        "assistant": EXTERNAL if ASSISTANT in names else "none",
        "seat": units,
        "cockpit": any(name in flown for name in names),
    }


def make_agents(
    names: Sequence[str], setup: Setup, perceptions: Mapping[str, Perception]
) -> dict[str, Agent]:
    """Return the agents of a run by name."""
    flown = aircraft_of(setup.scenario)
    agents: dict[str, Agent] = {}
    for name in names:
        perception = perceptions[name]
        if name == ASSISTANT:
            agents[name] = Assistant(name, flown, setup, perception)
        elif name in flown:
            agents[name] = Pilot(name, (name,), setup, perception)
        else:
            agents[name] = Controller(name, flown, setup, perception)
    return agents
