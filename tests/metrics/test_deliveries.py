"""What a warning can rest on: what had been delivered to who gives it."""

from __future__ import annotations

from typing import Any, cast

import pytest

from airhilt.messages import (
    AdsbReport,
    Advisory,
    Detections,
    Evidence,
    RadarPlot,
    Severity,
    SpokenTruth,
    Transcript,
)
from airhilt.metrics.deliveries import Deliveries
from airhilt.sim import StepRecord
from airhilt.units import seconds_to_ns

CALLSIGNS = {"AAL1": "AAL1", "DAL2": "DAL2", "UAL3": "UAL3", "aaaaa1": "AAL1", "ddddd2": "DAL2"}
PAIR = ("AAL1", "DAL2")


class Followed:
    """A decider that subscribes to transponders and transcripts, and what is published."""

    def __init__(self, seen: tuple[str, ...] = ()) -> None:
        keys = ["adsb/*", "asr/*", "radar/*", "vision/*"]
        self.deliveries = Deliveries(
            {"wolf": keys}, CALLSIGNS, PAIR, lambda actor, _: actor in seen
        )

    def reported(self, icao24: str, t_s: float) -> Followed:
        report = AdsbReport.model_construct(**cast(Any, {"icao24": icao24, "t_ns": _ns(t_s)}))
        self.deliveries.take(f"adsb/{icao24}", report)
        return self

    def said(self, name: str, t_s: float, speaker: str, addressed: str) -> Followed:
        spoken = {"id": name, "speaker": speaker, "addressed": addressed, "t_ns": _ns(t_s)}
        self.deliveries.take("truth", SpokenTruth.model_construct(**cast(Any, spoken)))
        found = {"id": name, "speaker": None, "addressee": None, "t_ns": _ns(t_s)}
        self.deliveries.take("asr/119100", Transcript.model_construct(**cast(Any, found)))
        return self

    def decides(self, t_s: float) -> Followed:
        self.deliveries.step(StepRecord("wolf", 0, _ns(t_s), _ns(t_s), 0, 0.0, 0))
        return self

    def judged(
        self, name: str = "wolf-1", traffic: tuple[str, ...] = PAIR, **evidence: Any
    ) -> tuple[bool, tuple[str, ...]]:
        """Return whether a warning of the pair at 60 s is founded, and what of it is not."""
        advisory = Advisory(
            t_ns=_ns(60.0), id=name, revision=0, recipient="AAL1", recipients=PAIR,
            kind="loss_of_separation", severity=Severity.WARNING, traffic=traffic, message="",
            evidence=Evidence(sources=("radio",), **evidence), t_ready_ns=0,
        )  # fmt: skip
        return self.deliveries.is_founded(advisory, PAIR), self.deliveries.unfounded(advisory)


def _ns(t_s: float) -> int:
    return seconds_to_ns(t_s)


def both_reported(t_s: float) -> Followed:
    return Followed().reported("aaaaa1", t_s).reported("ddddd2", t_s)


def test_a_warning_rests_on_what_was_delivered_before_its_step_began() -> None:
    assert both_reported(3.0).decides(4.0).judged() == (True, ())
    assert both_reported(3.0).decides(2.0).judged() == (False, ())
    assert Followed().reported("aaaaa1", 3.0).decides(4.0).judged() == (False, ())


def test_what_the_decider_does_not_subscribe_to_was_not_delivered_to_it() -> None:
    followed = both_reported(3.0)
    followed.deliveries = Deliveries({"wolf": ["asr/*"]}, CALLSIGNS, PAIR, lambda *_: False)
    assert followed.reported("aaaaa1", 3.0).decides(4.0).judged() == (False, ())


def test_a_program_without_steps_has_whatever_was_published() -> None:
    assert both_reported(3.0).judged("other-1") == (True, ())
    assert both_reported(61.0).judged("other-1") == (False, ())


@pytest.mark.parametrize(
    ("evidence", "unfounded"),
    [
        ({"radio_ids": ("takeoff",)}, ()),
        ({"radio_ids": ("never said",)}, ("never said",)),
        ({"radio_ids": ("of the future",)}, ("of the future",)),
        ({"radio_ids": ("unrelated",)}, ("unrelated",)),
        ({"radio_ids": ("unrelated", "takeoff")}, ("unrelated",)),
        ({"tracks": ("aaaaa1",)}, ()),
        ({"tracks": ("abcdef",)}, ("abcdef",)),
        ({"tracks": ("its own name",)}, ()),
        ({"camera_ids": ("nose",)}, ("nose",)),
    ],
)
def test_what_is_cited_must_exist_be_earlier_and_concern_who_is_named(
    evidence: dict[str, Any], unfounded: tuple[str, ...]
) -> None:
    followed = both_reported(3.0).said("takeoff", 4.0, "Tower", "AAL1").decides(6.0)
    followed.said("unrelated", 5.0, "UAL3", "Tower").said("of the future", 50.0, "AAL1", "Tower")
    (cited,) = evidence.values()
    assert followed.judged(**evidence) == (not unfounded or len(cited) > 1, unfounded)


def test_who_is_not_told_of_by_any_message_may_have_been_seen_by_a_camera_of_the_decider() -> None:
    followed = Followed(seen=("DAL2",)).reported("aaaaa1", 3.0).decides(4.0)
    assert followed.judged() == (False, ())
    found = Detections.model_construct(**cast(Any, {"camera": "nose", "t_ns": _ns(3.0)}))
    followed.deliveries.take("vision/nose", found)
    assert followed.judged() == (True, ())


def test_a_target_without_a_name_may_be_one_of_the_two_and_not_both() -> None:
    plot = RadarPlot.model_construct(**cast(Any, {"t_ns": _ns(3.0)}))
    followed = Followed()
    followed.deliveries.take("radar/tower", plot)
    assert followed.decides(4.0).judged() == (False, ())
    assert followed.reported("aaaaa1", 3.0).judged() == (True, ())


def test_a_name_that_nobody_has_makes_no_call_of_others_an_evidence() -> None:
    followed = both_reported(3.0).said("unrelated", 4.0, "UAL3", "Tower").decides(6.0)
    followed.said("of the ground", 4.0, "Ops one", "Tower")
    ghost = (*PAIR, "GHOST")
    assert followed.judged(traffic=ghost, radio_ids=("unrelated",)) == (False, ("unrelated",))
    assert followed.judged(traffic=ghost, radio_ids=("of the ground",)) == (True, ())
