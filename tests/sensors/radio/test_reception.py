"""The reception of a call by its line, its speaker, the radio, and the receiver of its listener."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.scenario.models import Radio
from airhilt.sensors.radio.on_air import Utterance
from airhilt.sensors.radio.reception import Receptions

KHZ = 118_300
RATIOS = st.none() | st.integers(-30, 60).map(float)


def receptions(receivers: dict[str, float], **radio: Any) -> Receptions:
    given = {name: {"snr_db": snr_db} for name, snr_db in receivers.items()}
    return Receptions(Radio.model_validate({"receivers": given, **radio}))


def said(speaker: str = "Tower", line: str | None = None) -> Utterance:
    return Utterance("call", KHZ, speaker, None, "words", line=line)


@pytest.mark.parametrize(
    ("call_db", "receiver_db", "heard_db"), [(20.0, 3.0, 3.0), (-2.0, 3.0, -2.0), (None, 3.0, 3.0)]
)
def test_a_listener_hears_a_call_with_the_lower_one_of_both_ratios(
    call_db: float | None, receiver_db: float, heard_db: float
) -> None:
    radio = receptions({"AAL123": receiver_db}, snr_db=call_db)
    assert radio.of(said(), "AAL123").snr_db == heard_db
    assert radio.of(said(), "UAL7").snr_db == call_db
    assert radio.of(said()).snr_db == call_db


@settings(deadline=None)
@given(RATIOS, RATIOS, RATIOS, st.integers(-30, 60), st.floats(0.0, 1.0))
def test_no_receiver_makes_a_call_better_than_it_is(
    line_db: float | None,
    station_db: float | None,
    radio_db: float | None,
    receiver_db: int,
    wet: float,
) -> None:
    radio = receptions(
        {"AAL123": float(receiver_db)},
        snr_db=radio_db,
        wet=wet,
        stations={"Tower": {"snr_db": station_db}},
        lines=[{"id": "line", "speaker": "Tower", "frequency_khz": KHZ, "text": "x",
                "snr_db": line_db}],
    )  # fmt: skip
    call, heard = radio.of(said(line="line")), radio.of(said(line="line"), "AAL123")
    assert heard.snr_db is not None
    assert heard.snr_db <= min(receiver_db, float("inf") if call.snr_db is None else call.snr_db)
    assert heard.wet == call.wet


def test_a_receiver_below_the_squelch_stays_silent_where_others_do_not() -> None:
    radio = receptions({"AAL123": -20.0}, snr_db=20.0)
    assert not radio.opens_squelch(said(), "AAL123")
    assert radio.opens_squelch(said(), "UAL7")
    assert radio.opens_squelch(said())


def test_nobody_hears_the_own_voice_through_the_own_receiver() -> None:
    radio = receptions({"AAL123": -20.0}, snr_db=20.0)
    assert radio.of(said("AAL123"), "AAL123").snr_db == 20.0
    assert radio.opens_squelch(said("AAL123"), "AAL123")
