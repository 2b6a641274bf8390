"""Input that cannot be right is left out or named, and never a silent wrong advisory."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import airhilt
from airfield import NORTH, Airfield, Mover, lands, stands
from airhilt import Scenario
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.messages import (
    AdsbReport,
    Advisory,
    CameraInfo,
    Detections,
    Event,
    Evidence,
    Message,
    Severity,
    Transcript,
)
from airhilt.record import read_log
from airhilt.sim import Input
from airhilt.surveillance.receivers import Receiver
from airhilt.units import SECOND_NS
from encounters import Encounter, Flight, head_on
from field_cameras import beside_threshold, silent
from projected import TRUCK

INCONSISTENT = "ADS-B of DAL456 inconsistent"


# --- ADS-B ----------------------------------------------------------------------------------


def changed(encounter: Encounter, change: Callable[[int, list[Input]], list[Input]]) -> Encounter:
    """Let what the receiver gives out at each step go through a function first."""
    hear = encounter._reports

    def reports(station: Receiver, t_ns: int, step: int) -> list[Any]:
        return change(step, hear(station, t_ns, step))

    encounter._reports = reports
    return encounter


def report_of(item: Input) -> AdsbReport:
    return AdsbReport.model_validate_json(item.payload)


def with_report(item: Input, **values: Any) -> Input:
    false = report_of(item).model_copy(update=values)
    return replace(item, payload=false.model_dump_json().encode())


def far_apart(seconds: float = 100.0) -> Encounter:
    """Two at one level that pass each other 60 NM apart."""
    return Encounter(
        [
            Flight("AAL123", "a1b2c3", 90.0, 30.7, 35_000),
            Flight("DAL456", "a4d5e6", 270.0, 30.7, 35_000, offset_nm=60.0),
        ],
        seconds,
    )


def ahead_of_the_other(step: int, inputs: list[Input]) -> Input:
    """Return a false report: the second aircraft is a degree ahead of the first."""
    first, second = (report_of(item) for item in inputs)
    return with_report(
        inputs[1],
        latitude_deg=first.latitude_deg,
        longitude_deg=first.longitude_deg + 0.4,
        altitude_ft=first.altitude_ft,
        t_adsb_in_ns=second.t_adsb_in_ns,
    )


def test_two_places_of_one_address_are_no_conflict_at_the_false_one() -> None:
    def spoof(step: int, inputs: list[Input]) -> list[Input]:
        false = [ahead_of_the_other(step, inputs)] if step >= 60 and len(inputs) == 2 else []
        return [*inputs, *false]

    assert changed(far_apart(), spoof).fly().told == []


def test_what_is_told_of_an_aircraft_with_two_places_says_so() -> None:
    def spoof(step: int, inputs: list[Input]) -> list[Input]:
        if step < 60 or len(inputs) < 2:
            return inputs
        return [*inputs, with_report(inputs[1], latitude_deg=30.0)]

    told = [advisory for _, advisory in changed(head_on(150.0), spoof).fly().told]
    assert [str(advisory.severity) for advisory in told if advisory.recipient == "DAL456"]
    assert all(INCONSISTENT in advisory.evidence.inconsistencies for advisory in told)
    honest = [advisory for _, advisory in head_on(150.0).fly().told]
    assert [each.severity for each in told] == [each.severity for each in honest]
    assert all(not advisory.evidence.inconsistencies for advisory in honest)


def test_a_place_that_is_all_that_is_heard_is_believed_after_a_while_and_said_to_be_doubtful() -> (
    None
):
    def moved(step: int, inputs: list[Input]) -> list[Input]:
        if step < 60 or len(inputs) < 2:
            return inputs
        return [inputs[0], ahead_of_the_other(step, inputs)]

    told = changed(far_apart(), moved).fly().told
    begun_s, first = told[0]
    assert 30.0 + 12.0 <= begun_s <= 30.0 + 16.0
    assert INCONSISTENT in first.evidence.inconsistencies


def test_a_callsign_of_two_addresses_is_told() -> None:
    encounter = head_on(150.0)
    encounter.flights.append(Flight("DAL456", "abcdef", 0.0, 300.0, 20_000))
    told = [advisory for _, advisory in encounter.fly().told]
    assert told
    for advisory in told:
        assert "callsign DAL456 sent by two addresses" in advisory.evidence.inconsistencies


def test_a_jump_on_to_the_runway_sends_nobody_around() -> None:
    field = Airfield(
        [Mover("AAL123", NORTH, lands(60.0)), Mover("OPS1", NORTH, stands(800.0, 1500.0))]
    )
    on_runway = field.movers[1]
    hear = field._report

    def report(station: Receiver, mover: Mover, t_ns: int, step: int) -> list[Input]:
        if mover is on_runway and 40 <= step < 60:
            mover = replace(mover, spot=stands(1200.0))
            mover.transponder = on_runway.transponder
        return hear(station, mover, t_ns, step)

    field._report = report
    assert field.run(50.0).told == []


# --- transcripts ----------------------------------------------------------------------------

PROCEED = "Ops one, proceed onto runway zero one at delta for inspection."
HOLD = "Ops one, hold short of runway zero one."


@dataclass
class Reordered(Airfield):
    """An airfield whose transcripts arrive at times of their own, and may come twice."""

    arrivals: Sequence[tuple[float, int]] = ()
    """When a transcript arrives, and of which call."""
    second_texts: tuple[str, ...] = ()
    """Words of the calls when they come a second time."""

    def _transcripts(self, t_ns: int) -> list[Input]:
        return list(self._arriving(t_ns))

    def _arriving(self, t_ns: int) -> Iterator[Input]:
        for index, (at_s, number) in enumerate(self.arrivals):
            if round(at_s * SECOND_NS) != t_ns:
                continue
            end_s, text = self.calls[number]
            if number in [earlier for _, earlier in self.arrivals[:index]] and self.second_texts:
                text = self.second_texts[number]
            end_ns = round(end_s * SECOND_NS)
            heard = Transcript(
                id=str(number), frequency_khz=119100, t_tx_ns=end_ns - 3 * SECOND_NS,
                t_end_ns=end_ns, text=text, confidence=1.0, engine="text",
            )  # fmt: skip
            yield Input("asr/119100", t_ns, heard.model_dump_json().encode())


def told_with(*arrivals: tuple[float, int], second_texts: tuple[str, ...] = ()) -> Airfield:
    calls = [(10.0, PROCEED), (15.0, HOLD)]
    field = Reordered(
        [Mover("AAL123", NORTH, lands(90.0))], calls, arrivals=arrivals, second_texts=second_texts
    )
    return field.run(50.0)


def test_the_last_word_counts_though_an_earlier_call_is_recognised_after_it() -> None:
    assert told_with((10.0, 0), (15.0, 1)).told == []
    assert told_with((15.0, 1), (18.0, 0)).told == []


def test_calls_out_of_order_are_named_in_what_rests_on_the_radio() -> None:
    proceeds = told_with((10.0, 0))
    assert proceeds.worst == Severity.CAUTION
    assert not proceeds.to("ATC")[0].evidence.inconsistencies
    field = Reordered(
        [Mover("AAL123", NORTH, lands(90.0))],
        [(10.0, HOLD), (15.0, PROCEED)],
        arrivals=((15.0, 1), (18.0, 0)),
    ).run(50.0)
    assert field.worst == Severity.CAUTION
    assert field.to("ATC")[0].evidence.inconsistencies == ("call 0 came out of order",)


def test_a_transcript_that_comes_twice_counts_once_and_the_first_is_believed() -> None:
    once, twice = told_with((10.0, 0)), told_with((10.0, 0), (12.0, 0), (20.0, 0))
    assert [(t_s, told.severity) for t_s, told in twice.told] == [
        (t_s, told.severity) for t_s, told in once.told
    ]
    other = told_with((10.0, 0), (12.0, 0), second_texts=(HOLD, HOLD))
    assert other.worst == Severity.CAUTION
    assert other.to("ATC")[0].evidence.inconsistencies == ("two transcripts of call 0 differ",)


# --- cameras --------------------------------------------------------------------------------


def announced(*cameras: str) -> list[Input]:
    return [
        Input(
            f"camera/{name}/info",
            0,
            CameraInfo(
                camera=name, rate_hz=8.0, width_px=640, height_px=360, horizontal_fov_deg=45.0
            )
            .model_dump_json()
            .encode(),
        )
        for name in cameras
    ]


def seen_by(*known: str) -> Airfield:
    """A truck without transponder stands on the runway before an arrival, and a camera shows it."""
    truck = silent(stands(800))
    camera = beside_threshold(truck.body("truck", TRUCK))
    field = Airfield([Mover("AAL123", NORTH, lands(70.0)), truck], cameras=[camera])
    field.worker.step(0, announced(*known, *([camera.name] if "its own" in known else [])))
    return field.run(60.0)


def test_what_an_unknown_camera_shows_is_not_used() -> None:
    assert seen_by("its own").worst == Severity.WARNING
    assert seen_by("another").told == []


def test_an_alert_by_sight_names_the_camera_that_was_not_used() -> None:
    truck = silent(stands(800))
    known, ghost = (
        replace(beside_threshold(truck.body("truck", TRUCK)), name=name)
        for name in ("known", "ghost")
    )
    field = Airfield([Mover("AAL123", NORTH, lands(70.0)), truck], cameras=[known, ghost])
    field.worker.step(0, announced("known"))
    first = field.run(60.0).to("ATC")[0]
    assert first.evidence.inconsistencies == ("detections of unknown camera ghost not used",)


def test_a_picture_that_comes_late_or_twice_changes_nothing() -> None:
    truck = silent(stands(800))
    camera = beside_threshold(truck.body("truck", TRUCK))
    pictures = camera.inputs

    def twice(begin_ns: int, end_ns: int) -> list[Input]:
        inputs = pictures(begin_ns, end_ns)
        return [each for item in inputs for each in (item, replace(item, payload=_empty(item)))]

    camera.inputs = twice
    field = Airfield([Mover("AAL123", NORTH, lands(70.0)), truck], cameras=[camera]).run(60.0)
    assert field.worst == Severity.WARNING


def _empty(item: Input) -> bytes:
    """Return a second result for a picture, in which nothing is found."""
    seen = Detections.model_validate_json(item.payload)
    return seen.model_copy(update={"detections": ()}).model_dump_json().encode()


# --- engines of other packages --------------------------------------------------------------


class Careless:
    """An engine whose only alert goes to somebody who cannot be addressed."""

    name = "careless"
    reads: tuple[type[Message], ...] = (AdsbReport,)

    def receive(self, received: ReceivedMessage) -> None: ...

    def decide(self, t_ns: int) -> Decision:
        alert = Alert(
            id="first",
            revision=0,
            kind="runway_conflict",
            severity=Severity.WARNING,
            recipients=("the crew ahead",),
            traffic=(),
            evidence=Evidence(sources=("adsb",)),
        )
        return Decision([alert])


def test_an_alert_that_makes_no_advisory_costs_its_worker_and_not_the_run(
    encounter: Scenario, tmp_path: Path
) -> None:
    short = encounter.model_copy(update={"duration_s": 5.0})
    result = airhilt.run(
        short, out=tmp_path / "run", latency="fixed", speech=False, cameras=False,
        workers=[DecisionWorker(Careless(), Template())],
    )  # fmt: skip
    assert result.summary.outcome == "finished"
    log = list(read_log(result.folder / "log.mcap"))
    lost = [Event.model_validate_json(m.data) for m in log if m.key == "truth/event"]
    (text,) = [event.text for event in lost if event.kind == "worker_lost"]
    assert "1 validation error for Advisory" in text
    assert not [Advisory for m in log if m.key.startswith("advisory/")]
