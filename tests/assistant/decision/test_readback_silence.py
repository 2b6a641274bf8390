"""An instruction to keep off a runway that nobody reads back is told, once its readback is late."""

from __future__ import annotations

from airfield import NORTH, Airfield, Mover, lands, stands
from airhilt.assistant.decision.readback_silence import ReadbackSilence
from airhilt.messages import TransmissionOpened
from airhilt.units import SECOND_NS
from decisions import transcript

CANCEL = "Delta four five six, cancel takeoff clearance, hold position."
READ_BACK = "Cancel takeoff, hold position, Delta four five six."
BETWEEN_OTHERS = "American one two three, wind calm."


def field(*calls: tuple[float, str], traffic: bool = True, openings: bool = True) -> Airfield:
    """One stands on the runway, told at 30 s that it is not to go; another is on final for it."""
    movers = [Mover("DAL456", NORTH, stands(50.0))]
    if traffic:
        movers.append(Mover("AAL123", NORTH, lands(110)))
    return Airfield(movers, [(30.0, CANCEL), *calls], openings_are_heard=openings)


def silences(airfield: Airfield) -> list[tuple[float, str]]:
    return [
        (t_s, advisory.recipient)
        for t_s, advisory in airfield.told
        if advisory.active and "not read back" in advisory.message
    ]


def test_silence_after_an_instruction_is_told_to_the_crew_and_the_controller() -> None:
    airfield = field().run(60.0)
    assert silences(airfield) == [(35.0, "DAL456"), (35.0, "ATC")]
    told = airfield.to("DAL456")[0]
    assert (told.kind, told.severity) == ("readback_mismatch", "CAUTION")
    assert "cancel takeoff" in told.message
    assert told.evidence.sources == ("radio", "adsb")
    assert airfield.advice("DAL456")[0] == ("cancel_takeoff", "01")


def test_words_that_are_not_recognised_yet_may_be_the_readback() -> None:
    airfield = field((35.0, READ_BACK))
    airfield.recognition_s = 12.0
    assert silences(airfield.run(60.0)) == []


def test_a_call_between_others_puts_it_off() -> None:
    airfield = field((37.0, BETWEEN_OTHERS)).run(60.0)
    assert [t_s for t_s, _ in silences(airfield)] == [42.0, 42.0]


def test_where_transmissions_are_not_heard_to_begin_nothing_is_known_of_silence() -> None:
    assert silences(field(openings=False).run(60.0)) == []


INSTRUCTED = transcript("cancel", 118_100, 0, 3 * SECOND_NS, CANCEL)


def opened(name: str, frequency_khz: int, t_s: float) -> TransmissionOpened:
    return TransmissionOpened(id=name, frequency_khz=frequency_khz, t_tx_ns=round(t_s * SECOND_NS))


def late_after(*others: TransmissionOpened, t_s: float) -> bool:
    """Return whether the readback is late at a time, after others have begun to transmit."""
    silence = ReadbackSilence()
    silence.take_opening(opened("cancel", 118_100, 0.0))
    silence.take_transcript(INSTRUCTED)
    for other in others:
        silence.take_opening(other)
    return silence.is_late(INSTRUCTED, round(t_s * SECOND_NS))


def test_calls_on_another_frequency_do_not_put_it_off() -> None:
    assert late_after(opened("other", 121_900, 5.0), t_s=8.0)
    assert not late_after(opened("other", 118_100, 5.0), t_s=8.0)


def test_a_transmission_without_words_is_no_readback_in_the_end() -> None:
    carrier = opened("carrier", 118_100, 5.0)
    assert not late_after(carrier, t_s=34.9)
    assert late_after(carrier, t_s=35.0)
