"""A radio whose actors only note what they are told to do, and the lines that are said on it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import fields
from types import SimpleNamespace
from typing import Any, TypeVar

from airhilt.messages import HearingTruth, Message, SpokenTruth, Transcript
from airhilt.scenario.failures import EffectiveLine, apply_failures
from airhilt.scenario.models import ResponseModel, Scenario
from airhilt.seats import Seats
from airhilt.sensors.radio.backends import RadioBackend, TextRadio
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.conversation import RadioConversation
from airhilt.sensors.radio.hearing import Heard, HearingModel
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director, Priority, Virtual
from airhilt.units import FOOT, SECOND_NS, seconds_to_ns
from airhilt.world.loading import load
from airhilt.world.site import FixedSite, ScenarioSite
from seats import state_of

W = TypeVar("W", bound="World")

TOWER, KHZ = "Washington Center", 134_325
CLIMB = {"action": "altitude", "altitude_ft": 33000}


def line(name: str, at_s: float, speaker: str, to: str, text: str, **more: Any) -> dict[Any, Any]:
    return {
        "id": name, "at_s": at_s, "speaker": speaker, "to": to, "frequency_khz": KHZ,
        "text": text, **more,
    }  # fmt: skip


CLEARANCE = line(
    "clearance", 10, TOWER, "AAL123",
    "American one two three, climb and maintain flight level three three zero.",
    commands=[{"actor": "AAL123", "delay_s": 2.0, "command": CLIMB}],
)  # fmt: skip
READBACK = line(
    "readback", 16, "AAL123", TOWER,
    "Climb and maintain flight level three three zero, American one two three.",
)  # fmt: skip


def radio_context(**given: Any) -> RadioContext:
    """Return the context of a radio that uses only what is given."""
    return RadioContext(**{each.name: None for each in fields(RadioContext)} | given)


class World:
    """A radio with a director, and actors that only note what they are told to do."""

    def __init__(
        self,
        *lines: dict[Any, Any],
        failures: list[Any] | tuple[Any, ...] = (),
        heard: dict[tuple[str, str], Heard] | None = None,
        hearing: HearingModel | None = None,
        seats: Collection[str] = (),
        backend: RadioBackend | None = None,
        controllers: dict[str, Any] | None = None,
        strangers: Collection[str] = (),
        crews: ResponseModel | None = None,
        **radio: Any,
    ) -> None:
        document = load("s02a_nominal").model_dump(mode="json")
        document["controllers"] = controllers or {}
        for actor in document["actors"]:
            actor["on_roster"] = actor["callsign"] not in strangers
        document["radio"] |= {"lines": list(lines), **radio}
        document |= {"failures": list(failures), "end_when": [], "conflict": None}
        document["perturbations"] = []
        if crews is not None:
            document["crews"] = crews
        self.scenario = Scenario.model_validate(document)
        self.director = Director(Virtual())
        self.published: list[Any] = []
        self.done: list[Any] = []
        self.microphones: list[tuple[float, str | None]] = []
        self.begun: list[tuple[float, str]] = []
        self.ended_lines: set[str] = set()
        high = FixedSite(0.68, -1.34, altitude_m=33_000 * FOOT)
        self.actors = {
            actor.callsign: SimpleNamespace(
                actor=actor,
                category="aircraft",
                bound_runway=None,
                body=SimpleNamespace(ended=None, state=high, on_ground=False),
            )
            for actor in self.scenario.actors
        }
        stations = Stations(self.actors, ScenarioSite.of(self.scenario), self.scenario)
        self.seats = Seats(
            (
                state_of(name, frequencies_khz=tuned, tuned_khz=tuned)
                for name in seats
                for tuned in [stations.selectable(name)]
            ),
            self.publish,
            self.director,
        )
        self.seats.open()
        context = RadioContext(
            self.director,
            self.scenario,
            apply_failures(self.scenario),
            stations,
            backend or TextRadio(self.scenario.radio.words_per_minute),
            7,
            self,
            self,
            self.publish,
            self.seats,
        )
        self.conversation = RadioConversation(
            context, hearing=hearing if heard is None else Scripted(heard)
        )
        self.conversation.start()

    def publish(
        self,
        key: str,
        message: Message,
        *,
        raw: bytes | None = None,
    ) -> None:
        self.published.append(message)
        if isinstance(message, Transcript) and self.gives_transcripts:
            self.conversation.take(key, message, b"")

    gives_transcripts = True

    def once(self, condition: Any, action: Any) -> None:
        del condition
        self.director.at(self.director.now_ns, action, Priority.SCRIPT)

    def refusal(self, callsign: str, command: Any) -> str | None:
        return None

    def never(self, condition: Any) -> str | None:
        return None

    def no_response(self, callsign: str, text: str) -> None:
        self.done.append((callsign, text, self.now_s))

    def do(self, callsign: str, command: Any) -> None:
        self.done.append((callsign, command, self.now_s))

    def line_begun(self, line: str) -> None:
        self.begun.append((self.now_s, line))

    def line_failed(self, line: EffectiveLine) -> None:
        pass

    def microphone_stuck(self, callsign: str, text: str) -> None:
        del text
        self.microphones.append((self.now_s, callsign))

    def microphones_free(self) -> None:
        self.microphones.append((self.now_s, None))

    @property
    def now_s(self) -> float:
        return self.director.now_ns / SECOND_NS

    def run(self: W) -> W:
        self.director.run()
        return self

    def run_until(self: W, end_s: float) -> W:
        self.director.at(seconds_to_ns(end_s), self.director.stop, Priority.OBSERVE)
        self.director.run()
        self.conversation.close()
        return self

    def said(self) -> list[str]:
        return [one.id for one in self.published if isinstance(one, SpokenTruth)]

    def spoken(self, name: str) -> SpokenTruth:
        return next(
            one for one in self.published if isinstance(one, SpokenTruth) and one.id == name
        )

    def hearings(self, actor: str) -> list[Any]:
        return [
            (one.id, one.outcome)
            for one in self.published
            if isinstance(one, HearingTruth) and one.actor == actor
        ]


class Scripted(HearingModel):
    """Hears each transmission as told, everything else well."""

    def __init__(self, heard: dict[tuple[str, str], Heard]) -> None:
        super().__init__(0)
        object.__setattr__(self, "_heard", heard)

    __slots__ = ("_heard",)
    _heard: dict[tuple[str, str], Heard]

    def listen(
        self,
        transmission: str,
        listener: str,
        text: str,
        snr_db: float | None,
        times: int = 1,
    ) -> Heard:
        return self._heard.get((transmission, listener), Heard("understood", text))


class Sharp(HearingModel):
    """Understands all that is above 0 dB, and nothing of what is below."""

    def listen(
        self,
        transmission: str,
        listener: str,
        text: str,
        snr_db: float | None,
        times: int = 1,
    ) -> Heard:
        is_loud = snr_db is None or snr_db >= 0.0
        return Heard("understood", text) if is_loud else Heard("unsure", text)


MISSED, UNSURE = Heard("missed", ""), Heard("unsure", "...")
