"""Controllers who are warned: what they say, to whom, when, and what comes of it."""

from __future__ import annotations

from functools import partial
from typing import Any

from airhilt.messages import (
    AdsbReport,
    Advisory,
    AirportBriefing,
    Briefing,
    CancelTakeoff,
    Climb,
    Confirm,
    EquipmentAlert,
    Event,
    Evidence,
    GoAround,
    HoldPosition,
    LeaveSeat,
    Message,
    Recommendation,
    RosterEntry,
    RunwayBriefing,
    SeatAction,
    Severity,
    SpokenTruth,
    TakeSeat,
)
from airhilt.sensors.radio.hearing import Heard
from airhilt.sim import Priority
from airhilt.units import seconds_to_ns
from conversations import CLEARANCE, KHZ, MISSED, READBACK, TOWER, World, line

PROMPT = {"reaction_median_s": 5.0, "reaction_sigma": 0.0}
HELLO = [line(f"hello-{name}", 1 + 4 * at, name, TOWER, "Hello.")
         for at, name in enumerate(("AAL123", "DAL456"))]  # fmt: skip
UP, DOWN = (
    Climb(sense="climb", altitude_ft=34_000.0, vertical_rate_fpm=1500.0),
    Climb(sense="descend", altitude_ft=32_000.0, vertical_rate_fpm=1500.0),
)


def advisory(name: str = "decision-1", at_s: float = 30.0, **more: Any) -> Advisory:
    """Return an advisory to the controller on a loss of separation of AAL123 and DAL456."""
    given: dict[str, Any] = {
        "t_ns": seconds_to_ns(at_s), "id": name, "revision": 0, "recipient": "ATC",
        "recipients": ("ATC",), "kind": "loss_of_separation", "severity": Severity.CAUTION,
        "traffic": ("AAL123", "DAL456"), "message": "traffic", "t_ready_ns": 0,
        "evidence": Evidence(sources=("adsb",)),
    }  # fmt: skip
    return Advisory(**given | more)


class Tower(World):
    """A unit whose controller reacts after 5 s, and takes what is published."""

    def __init__(self, *lines: dict[Any, Any], **more: Any) -> None:
        super().__init__(*lines or HELLO, **{"controllers": {TOWER: PROMPT}} | more)

    def gets(self, message: Message, key: str = "advisory/ATC") -> Tower:
        """Let a message come at its time."""
        take = partial(self.conversation.take, key, message, b"")
        self.director.at(message.t_ns, take, Priority.SCRIPT)
        return self

    def advises(self, at_s: float = 30.0, **recommended: Recommendation) -> Tower:
        """Advise the controller of something for each of some actors."""
        return self.gets(advisory(at_s=at_s, recommendations=recommended))

    def calls(self) -> list[SpokenTruth]:
        """Return the calls that the controllers have made of themselves, in their order."""
        spoken = [one for one in self.published if isinstance(one, SpokenTruth)]
        own = [one for one in spoken if one.id.startswith("controller.")]
        return sorted((one for one in own if "readback" not in one.id), key=lambda one: one.t_tx_ns)

    def told(self) -> list[tuple[str | None, str]]:
        """Return to whom the controllers have said what."""
        return [(one.addressed, one.text) for one in self.calls()]

    def events(self, kind: str) -> list[str]:
        """Return the texts of the events of a kind."""
        return [one.text for one in self.published if isinstance(one, Event) and one.kind == kind]


def flies(
    callsign: str, altitude_ft: float | None, north_deg: float = 0.0, **more: Any
) -> AdsbReport:
    """Return what the displays get of an aircraft at 29 s."""
    given: dict[str, Any] = {
        "t_ns": seconds_to_ns(29.0), "icao24": callsign.encode().hex()[:6],
        "callsign": callsign, "latitude_deg": 39.0 + north_deg, "longitude_deg": -77.0,
        "altitude_ft": altitude_ft, "emitter_category": "A3", "ground_speed_kt": 400.0,
        "track_deg": 0.0, "vertical_rate_fpm": 0.0, "nacp": 9, "nacv": 2, "receiver": "one",
        "t_adsb_in_ns": seconds_to_ns(29.0), "t_adsb_out_ns": seconds_to_ns(29.0),
    }  # fmt: skip
    return AdsbReport(**given | more)


# --- they react ------------------------------------------------------------------------------


def test_who_is_advised_says_it_after_the_reaction_time_and_the_crew_does_what_it_hears() -> None:
    world = Tower().advises(AAL123=UP).run_until(60.0)
    (call,) = world.calls()
    assert call.t_tx_ns == seconds_to_ns(35.0)
    assert "climb and maintain flight level three four zero" in call.text
    ((callsign, command, at_s),) = world.done
    assert (callsign, command.altitude_ft) == ("AAL123", 34_000.0)
    assert at_s > call.t_end_ns / 1e9
    assert world.said()[-1] == f"{call.id}.readback"


def test_a_crew_that_does_not_hear_the_call_does_nothing_and_it_is_made_again() -> None:
    name = "controller.Washington_Center.1"
    world = Tower(heard={(name, "AAL123"): MISSED}).advises(AAL123=UP).run_until(60.0)
    assert f"{name}.repeat-1" in world.said()
    ((_, _, at_s),) = world.done
    assert at_s > world.spoken(f"{name}.repeat-1").t_end_ns / 1e9


def test_a_crew_that_mishears_the_call_does_what_it_has_heard_until_it_is_corrected() -> None:
    name = "controller.Washington_Center.1"
    heard = Heard("misheard", "American one two three, climb flight level three eight zero.")
    world = Tower(heard={(name, "AAL123"): heard}).advises(AAL123=UP).run_until(60.0)
    assert [command.altitude_ft for _, command, _ in world.done] == [38_000.0, 34_000.0]
    (_, again) = world.calls()
    assert "negative, I say again, " in again.text


def test_a_controller_who_does_not_respond_says_nothing_and_that_is_told() -> None:
    idle = {TOWER: {**PROMPT, "compliance": 0.0}}
    world = Tower(controllers=idle).advises(AAL123=UP).run_until(60.0)
    assert world.told() == []
    assert world.events("controller_silent") == ["does not respond (decision-1)"]


def test_a_controller_acts_on_the_kinds_that_it_is_declared_to_act_on() -> None:
    runways = {TOWER: {**PROMPT, "acts_on": ["runway_conflict"]}}
    assert Tower(controllers=runways).advises(AAL123=UP).run_until(60.0).told() == []


def test_what_is_over_before_the_controller_has_looked_is_not_said() -> None:
    world = Tower().advises(AAL123=UP).gets(advisory(at_s=33.0, revision=1, active=False))
    assert world.run_until(60.0).told() == []


def test_the_conflict_alert_of_the_world_is_acted_on() -> None:
    alert = EquipmentAlert(
        t_ns=seconds_to_ns(30.0), equipment="conflict_alert", advisory=advisory()
    )
    world = Tower().gets(flies("AAL123", 33_000.0)).gets(flies("DAL456", 33_000.0, 0.3))
    world.gets(alert, "equipment/conflict_alert/ATC").run_until(60.0)
    said = dict(world.told())
    assert "climb and maintain flight level three four zero" in said["DAL456"]
    assert "descend and maintain flight level three two zero" in said["AAL123"]


# --- one call at a time ----------------------------------------------------------------------


def test_the_most_urgent_call_comes_first_and_no_call_before_the_last_has_ended() -> None:
    other = advisory(
        "decision-2", 30.0, severity=Severity.WARNING, traffic=("DAL456", "UAL88"),
        recommendations={"DAL456": DOWN},
    )  # fmt: skip
    world = Tower().advises(AAL123=UP).gets(other).run_until(60.0)
    first, second = world.calls()
    assert (first.addressed, second.addressed) == ("DAL456", "AAL123")
    assert second.t_tx_ns >= first.t_end_ns


def test_what_was_said_is_not_said_again_but_another_action_is() -> None:
    world = Tower().advises(AAL123=UP)
    world.gets(advisory(at_s=50.0, revision=1, recommendations={"AAL123": UP}))
    further = Climb(sense="climb", altitude_ft=37_000.0, vertical_rate_fpm=1500.0)
    world.gets(advisory(at_s=70.0, revision=2, recommendations={"AAL123": further}))
    world.gets(advisory(at_s=90.0, revision=3, recommendations={"AAL123": GoAround(runway="01")}))
    texts = [text for _, text in world.run_until(110.0).told()]
    assert len(texts) == 3
    assert "three seven zero" in texts[1]
    assert "go around" in texts[2]


def test_nobody_is_told_to_descend_who_was_told_to_climb_because_of_the_same_traffic() -> None:
    world = Tower().advises(AAL123=UP)
    world.gets(advisory("other-1", 50.0, recommendations={"AAL123": DOWN}))
    assert len(world.run_until(80.0).told()) == 1


def test_who_follows_a_resolution_advisory_is_told_nothing_until_it_is_clear_of_conflict() -> None:
    def equipment(at_s: float, **more: Any) -> EquipmentAlert:
        own = advisory("tcas-1", at_s, recipient="AAL123", recommendation=UP, **more)
        return EquipmentAlert(t_ns=seconds_to_ns(at_s), equipment="tcas", advisory=own)

    world = Tower().gets(equipment(15.0), "equipment/tcas/AAL123").advises(AAL123=DOWN)
    over = equipment(50.0, revision=1, active=False)
    world.gets(over, "equipment/tcas/AAL123")
    world.gets(advisory("decision-2", 60.0, recommendations={"AAL123": DOWN}))
    world.run_until(90.0)
    assert "TCAS RA" in world.spoken("ra.AAL123.1").text
    assert "clear of conflict" in world.spoken("ra.AAL123.2").text
    (call,) = world.calls()
    assert call.t_tx_ns > world.spoken("ra.AAL123.2").t_end_ns
    assert world.events("controller_silent") == ["AAL123 follows a TCAS RA (decision-1)"]


# --- what they decide by ---------------------------------------------------------------------

WRONG = {**READBACK, "text": "Climb and maintain flight level three five zero, American 123."}
MISMATCH: dict[str, Any] = {
    "kind": "readback_mismatch",
    "evidence": Evidence(sources=("radio",), radio_ids=("clearance", "readback")),
}
ROGER = line("roger", 24, TOWER, "AAL123", "American one two three, roger.")


def test_what_was_read_back_wrongly_is_said_again_and_done_instead() -> None:
    world = Tower(CLEARANCE, WRONG).gets(advisory(**MISMATCH)).run_until(60.0)
    ((addressed, text),) = world.told()
    assert addressed == "AAL123"
    assert text.startswith("American one twenty three, negative, I say again, climb")
    assert world.done[-1][1].altitude_ft == 33_000


def test_what_was_read_back_rightly_since_is_not_corrected_by_a_new_advisory() -> None:
    world = Tower(CLEARANCE, WRONG).gets(advisory(**MISMATCH))
    world.gets(advisory(at_s=50.0, revision=1, active=False, **MISMATCH))
    world.gets(advisory("decision-2", at_s=52.0, **MISMATCH))
    assert len(world.run_until(90.0).calls()) == 1


def test_what_is_read_back_wrongly_is_said_three_times_at_most() -> None:
    read = Heard("understood", "Climb flight level three eight zero, American one two three.")
    names = [f"controller.Washington_Center.{each}.readback" for each in (1, 2, 3, 4)]
    heard = dict.fromkeys(((name, TOWER) for name in names), Heard("misheard", read.text))
    world = Tower(heard=heard).advises(AAL123=UP).run_until(120.0)
    assert len(world.calls()) == 3


def test_a_line_of_the_script_waits_for_the_readback_of_a_correction() -> None:
    world = Tower(CLEARANCE, WRONG, ROGER).gets(advisory(at_s=18.0, **MISMATCH)).run_until(90.0)
    (correction,) = world.calls()
    readback = world.spoken(f"{correction.id}.readback")
    assert correction.t_tx_ns < seconds_to_ns(24.0)
    assert world.spoken("roger").t_tx_ns > readback.t_end_ns > correction.t_end_ns


def test_a_line_of_the_script_is_said_if_nobody_answers_a_correction() -> None:
    name = "controller.Washington_Center.1"
    every = (name, f"{name}.repeat-1", f"{name}.repeat-2")
    heard = dict.fromkeys(((each, "AAL123") for each in every), MISSED)
    world = Tower(CLEARANCE, WRONG, ROGER, heard=heard)
    said = world.gets(advisory(at_s=18.0, **MISMATCH)).run_until(120.0).said()
    assert said.index("roger") > said.index(every[1])
    assert "clearance.end" in said


def airport() -> Briefing:
    """Return the briefing of an airport with a runway to the north, at 39 degrees."""
    ends = ("01", (39.0, -77.0), (39.02, -77.0)), ("19", (39.02, -77.0), (39.0, -77.0))
    area = ((38.999, -77.001), (39.021, -77.001), (39.021, -76.999), (38.999, -76.999))
    runways = tuple(
        RunwayBriefing(
            ident=ident, threshold=begin, end=end, elevation_ft=0.0, width_m=45.0,
            protected_area=area,
        )
        for ident, begin, end in ends
    )  # fmt: skip
    roster = (RosterEntry(callsign="UAL88", category="vehicle", type="follow_me"),)
    return Briefing(
        t_ns=0, controller=TOWER, horizontal_separation_nm=3.0, vertical_separation_ft=1000.0,
        roster=roster, airport=AirportBriefing(icao="KXXX", elevation_ft=0.0, runways=runways),
    )  # fmt: skip


def stands(callsign: str, north_deg: float, east_deg: float = 0.0, kt: float = 0.0) -> AdsbReport:
    """Return what the displays get of somebody on the ground."""
    return flies(
        callsign, None, north_deg, on_ground=True, ground_speed_kt=kt,
        longitude_deg=-77.0 + east_deg,
    )  # fmt: skip


ON_FINAL = flies("AAL123", 500.0, -0.03, ground_speed_kt=130.0)


def conflict(*traffic: str, severity: Severity = Severity.WARNING) -> Advisory:
    """Return an advisory without recommendations on a runway conflict."""
    return advisory(kind="runway_conflict", traffic=traffic, severity=severity)


def test_without_recommendations_an_arrival_goes_around_and_a_departure_is_stopped() -> None:
    takeoff = line(
        "takeoff", 10, TOWER, "DAL456", "Delta four five six, runway zero one, cleared for takeoff."
    )
    world = Tower(*HELLO, takeoff).gets(airport()).gets(ON_FINAL).gets(stands("DAL456", 0.001))
    said = dict(world.gets(conflict("AAL123", "DAL456")).run_until(60.0).told())
    assert "go around" in said["AAL123"]
    assert "cancel takeoff clearance" in said["DAL456"]


def test_without_recommendations_who_is_short_of_the_runway_holds_and_the_arrival_lands() -> None:
    world = Tower().gets(airport()).gets(ON_FINAL).gets(stands("DAL456", 0.005, 0.003, kt=10.0))
    world.gets(conflict("AAL123", "DAL456")).run_until(60.0)
    assert [who for who, _ in world.told()] == ["DAL456"]
    assert "hold position" in world.told()[0][1]


def test_without_recommendations_the_arrival_goes_around_for_who_is_on_the_runway() -> None:
    world = Tower().gets(airport()).gets(ON_FINAL).gets(stands("DAL456", 0.005))
    world.gets(conflict("AAL123", "DAL456")).run_until(60.0)
    assert world.told() == [
        ("AAL123", "American one twenty three, go around, traffic on the runway.")
    ]


def test_a_driver_is_stopped_and_a_takeoff_that_was_not_cleared_is_not_cancelled() -> None:
    hold, cancel = HoldPosition(runway="01"), CancelTakeoff(runway="01")
    world = Tower().gets(airport()).gets(stands("UAL88", 0.005, 0.003))
    said = dict(world.advises(UAL88=hold, DAL456=cancel).run_until(60.0).told())
    assert "stop immediately" in said["UAL88"]
    assert said["DAL456"] == "Delta four fifty six, hold position."


def test_an_advisory_that_the_displays_contradict_may_be_ignored() -> None:
    for share, calls in ((0.0, 1), (1.0, 0)):
        controllers = {TOWER: {**PROMPT, "ignores_contradicted": share}}
        world = Tower(controllers=controllers)
        world.gets(flies("AAL123", 33_000.0)).gets(flies("DAL456", 20_000.0, 1.0))
        assert len(world.advises(AAL123=UP).run_until(60.0).told()) == calls
    assert world.events("controller_silent") == ["the displays contradict it (decision-1)"]


def test_near_traffic_is_a_safety_alert_and_far_traffic_is_named() -> None:
    for distance_deg, begins in ((0.2, "Traffic alert, American"), (1.5, "American one twenty")):
        world = Tower().gets(flies("AAL123", 33_000.0))
        opposite = flies("DAL456", 33_000.0, distance_deg, track_deg=180.0)
        ((_, text),) = world.gets(opposite).advises(AAL123=UP).run_until(60.0).told()
        assert text.startswith(begins)
        assert "traffic twelve o'clock" in text


# --- whom they work --------------------------------------------------------------------------

APPROACH = "Potomac Approach"
TWO_UNITS = {TOWER: PROMPT, APPROACH: {**PROMPT, "frequencies_khz": [124_700]}}
ELSEWHERE = {
    **line("hello-there", 9, "DAL456", APPROACH, "Hello."), "frequency_khz": 124_700,
}  # fmt: skip


def test_each_unit_speaks_to_those_who_are_with_it_on_its_own_frequency() -> None:
    world = (
        Tower(HELLO[0], ELSEWHERE, controllers=TWO_UNITS, stations={APPROACH: {}})
        .advises(AAL123=UP, DAL456=DOWN)
        .run_until(60.0)
    )
    calls = {call.addressed: (call.speaker, call.frequency_khz) for call in world.calls()}
    assert calls == {"AAL123": (TOWER, KHZ), "DAL456": (APPROACH, 124_700)}


def test_after_a_handover_the_unit_that_spoke_last_with_a_crew_works_it() -> None:
    again = {**ELSEWHERE, "id": "hello-again", "at_s": 20, "speaker": "AAL123"}
    world = Tower(HELLO[0], ELSEWHERE, again, controllers=TWO_UNITS, stations={APPROACH: {}})
    (call,) = world.advises(AAL123=UP).run_until(60.0).calls()
    assert (call.speaker, call.frequency_khz) == (APPROACH, 124_700)


def test_who_is_on_no_frequency_cannot_be_called_and_that_is_told() -> None:
    world = Tower(HELLO[0], strangers=["DAL456"]).advises(DAL456=DOWN).run_until(60.0)
    assert world.told() == []
    assert world.events("controller_silent") == ["no unit can call DAL456 (decision-1)"]


def test_nobody_speaks_for_the_person_at_the_unit_until_the_person_leaves() -> None:
    world = Tower(seats=[TOWER])

    def acts(at_s: float, act: Any) -> None:
        message = SeatAction(t_ns=seconds_to_ns(at_s), holder="somebody", act=act)
        world.gets(message, "seat/Washington_Center/do")
        take = partial(world.seats.take, "seat/Washington_Center/do", message, b"")
        world.director.at(message.t_ns, take, Priority.PHYSICS)

    acts(1.0, TakeSeat())
    world.advises(AAL123=UP)
    acts(60.0, LeaveSeat())
    (call,) = world.run_until(90.0).calls()
    assert call.t_tx_ns > seconds_to_ns(60.0)


def test_a_question_waits_while_a_conflict_is_shown() -> None:
    evidence = Evidence(sources=("radio",), radio_ids=("readback",))
    asks = advisory(
        "decision-2", kind="clarification", severity=Severity.ADVISORY, evidence=evidence,
        recommendation=Confirm(callsign="AAL123", slot="altitude"), traffic=("AAL123",),
    )  # fmt: skip
    world = Tower(CLEARANCE, READBACK).advises(DAL456=DOWN).gets(asks)
    world.run_until(60.0)
    assert not any("confirmation" in name for name in world.said())
