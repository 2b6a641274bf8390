"""Frames of Mode S: their parity, and what they carry."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.messages import AdsbReport
from airhilt.surveillance import mode_s
from airhilt.surveillance.mode_s_frames import FrameSource
from airhilt.surveillance.squitters import movement_code, movement_kt
from airhilt.units import SECOND_NS
from reports import REPORT, reports

squawks = st.from_regex(r"[0-7]{4}", fullmatch=True)


def downlink_format(frame: bytes) -> int:
    return frame[0] >> 3


@given(reports())
def test_the_remainder_of_a_squitter_is_0_and_that_of_a_reply_its_address(
    report: AdsbReport,
) -> None:
    for frame in FrameSource().frames(report):
        address = 0 if downlink_format(frame) in (11, 17, 18) else int(report.icao24, 16)
        assert mode_s.parity(frame) == address
        assert len(frame) == (14 if downlink_format(frame) >= 16 else 7)


@given(reports(), st.data())
def test_a_squitter_with_up_to_five_wrong_bits_is_found_out(
    report: AdsbReport, data: st.DataObject
) -> None:
    frame = data.draw(st.sampled_from([*FrameSource().frames(report)]))
    wrong = data.draw(st.sets(st.integers(0, 8 * len(frame) - 1), min_size=1, max_size=5))
    number = int.from_bytes(frame) ^ sum(1 << bit for bit in wrong)
    assert mode_s.parity(number.to_bytes(len(frame))) != mode_s.parity(frame)


def test_the_parity_is_that_of_a_published_frame() -> None:
    """The 1090 Megahertz Riddle (J. Sun, 2021), chapter 4: identification of KLM1023."""
    message = mode_s.identification("KLM1023", "A0")
    assert mode_s.extended_squitter(0x4840D6, message, on_ground=False).hex() == (
        "8d4840d6202cc371c32ce0576098"
    )


@given(squawks)
def test_every_squawk_has_an_identity_code_of_its_own(squawk: str) -> None:
    code = mode_s.identity_code(squawk)
    digits = [
        "".join(str(code >> bit & 1) for bit in bits)
        for bits in ((7, 9, 11), (1, 3, 5), (8, 10, 12), (0, 2, 4))
    ]
    assert "".join(str(int(bits, 2)) for bits in digits) == squawk
    assert code < 2**13
    assert not code >> 6 & 1


@pytest.mark.parametrize(
    ("altitude_ft", "code"),
    [(-1000.0, 0x010), (-975.0, 0x011), (38_000.0, 0xC38), (50_175.0, 0xFFF), (50_200.0, 0),
     (None, 0)],
)  # fmt: skip
def test_an_altitude_is_coded_in_steps_of_25_ft_or_not_at_all(
    altitude_ft: float | None, code: int
) -> None:
    assert mode_s.altitude_code(altitude_ft) == code


@given(st.floats(0.0, 200.0))
def test_a_movement_code_tells_the_speed_that_a_receiver_reports(speed_kt: float) -> None:
    assert movement_code(movement_kt(speed_kt)) == movement_code(speed_kt)


def kinds(seconds: float, **more: object) -> Counter[str]:
    """Count the frames of a minute's reports, two a second, by format and type code."""
    source, counted = FrameSource(), Counter[str]()
    for half in range(int(2 * seconds)):
        moment = {"t_adsb_in_ns": half * SECOND_NS // 2}
        for frame in source.frames(REPORT.model_copy(update=moment | more)):
            code = f"/{frame[4] >> 3}" if downlink_format(frame) in (17, 18) else ""
            counted[f"{downlink_format(frame)}{code}"] += 1
    return counted


def test_frames_come_at_the_periods_of_the_standards() -> None:
    assert kinds(60.0) == {
        "17/11": 120, "17/19": 120, "11": 60, "17/31": 24, "17/4": 12, "17/28": 12,
        "4": 12, "5": 12, "20": 12, "21": 12,
    }  # fmt: skip


def test_in_an_emergency_the_status_comes_about_once_a_second() -> None:
    assert kinds(60.0, squawk="7700", emergency="general")["17/28"] == 60


def test_on_the_ground_there_is_a_surface_position_and_no_velocity() -> None:
    on_ground = kinds(60.0, on_ground=True, altitude_ft=None)
    assert on_ground["17/7"] == 120
    assert "17/19" not in on_ground


def test_a_vehicle_sends_as_a_device_that_is_no_transponder_and_replies_to_nothing() -> None:
    vehicle = kinds(60.0, on_ground=True, altitude_ft=None, emitter_category="C2", squawk=None)
    assert {kind.partition("/")[0] for kind in vehicle} == {"18"}


@settings(max_examples=300)
@given(reports(), st.booleans())
def test_the_integrity_category_is_read_back_from_type_code_and_supplements(
    report: AdsbReport, on_ground: bool
) -> None:
    grounded = {"on_ground": on_ground, "altitude_ft": None if on_ground else 5000.0}
    messages = {
        frame[4] >> 3: int.from_bytes(frame[4:11])
        for frame in FrameSource().frames(report.model_copy(update=grounded))
        if downlink_format(frame) in (17, 18)
    }
    status = messages[31]
    supplement_a = status >> 12 & 1
    if on_ground:
        code = next(code for code in messages if 5 <= code <= 8)
        supplement, table = status >> 36 & 1, SURFACE_NIC
    else:
        code = next(code for code in messages if 9 <= code <= 18)
        supplement, table = messages[code] >> 48 & 1, AIRBORNE_NIC
    known = report.nic if not on_ground or report.nic > 5 else 0
    assert table[code, supplement_a, supplement] == known


AIRBORNE_NIC = {
    (9, 0, 0): 11, (10, 0, 0): 10, (11, 1, 1): 9, (11, 0, 0): 8, (12, 0, 0): 7, (13, 0, 0): 6,
    (14, 0, 0): 5, (15, 0, 0): 4, (16, 1, 1): 3, (16, 0, 0): 2, (17, 0, 0): 1, (18, 0, 0): 0,
}  # fmt: skip
SURFACE_NIC = {
    (5, 0, 0): 11, (6, 0, 0): 10, (7, 1, 0): 9, (7, 0, 0): 8, (8, 1, 1): 7, (8, 0, 1): 6,
    (8, 0, 0): 0,
}  # fmt: skip
