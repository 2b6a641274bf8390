"""People respond as their model says: at once, late, too slowly, the wrong way, or not at all."""

from __future__ import annotations

import math
from collections import Counter
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt import load
from airhilt.messages import Climb
from airhilt.scenario.models import (
    RESPONSE_MODELS,
    Channel,
    Channels,
    Reactions,
    ResponseModel,
    ResponseModelName,
    Responses,
)
from airhilt.world.actors.reactions import ReactionModel, Response, reaction_models
from breadth import examples

DOWN = Climb(sense="descend", altitude_ft=34_400.0, vertical_rate_fpm=1500.0)
SEEDS = 2000
OWN = Reactions()


def responses(
    channels: Channels, channel: Channel, own: Reactions = OWN, *, is_vertical: bool = True
) -> list[Response]:
    """Return the responses to one advisory in runs with different seeds."""
    models = (ReactionModel("AAL123", channels, own, seed) for seed in range(SEEDS))
    return [model.respond(channel, "d-1", is_vertical=is_vertical) for model in models]


def shares(found: list[Response]) -> dict[str, float]:
    return {kind: count / len(found) for kind, count in Counter(r.kind for r in found).items()}


@pytest.mark.parametrize("name", get_args(ResponseModelName))
@pytest.mark.parametrize("role", ["crews", "drivers"])
@pytest.mark.parametrize("channel", get_args(Channel))
def test_shares_are_those_of_the_table(
    name: ResponseModelName, role: str, channel: Channel
) -> None:
    channels: Channels = getattr(RESPONSE_MODELS[name], role)
    table = channels.of(channel)
    found = shares(responses(channels, channel))
    expected = {
        "none": table.no_response,
        "late": table.late,
        "weak": table.weak,
        "opposite": table.opposite,
    }
    for kind, share in expected.items():
        spread = 3.5 * math.sqrt(share * (1.0 - share) / SEEDS)
        assert found.get(kind, 0.0) == pytest.approx(share, abs=spread)


def test_as_observed_a_resolution_advisory_is_followed_in_six_of_ten_as_told_in_four() -> None:
    found = shares(responses(RESPONSE_MODELS["observed"].crews, "ra"))
    assert found["prompt"] == pytest.approx(0.38, abs=0.04)
    assert found["prompt"] + found["late"] + found["weak"] == pytest.approx(0.60, abs=0.04)


def test_as_observed_one_controller_in_twenty_takes_more_than_13_s() -> None:
    observed = Channels(assistant=RESPONSE_MODELS["observed"].controllers)
    found = responses(observed, "assistant")
    delays = sorted(each.delay_s for each in found)
    assert delays[int(0.95 * SEEDS)] == pytest.approx(13.0, rel=0.06)


def test_a_wrong_sense_or_a_slow_rate_is_of_climbs_and_descents_alone() -> None:
    observed = RESPONSE_MODELS["observed"].crews
    found = shares(responses(observed, "ra", is_vertical=False))
    assert found.keys() == {"prompt", "late", "none"}


def test_what_an_actor_has_of_its_own_replaces_the_model() -> None:
    observed = RESPONSE_MODELS["observed"].crews
    own = Reactions(reaction_median_s=3.0, reaction_sigma=0.0, compliance=0.25)
    found = responses(observed, "assistant", own)
    assert shares(found)["none"] == pytest.approx(0.75, abs=0.04)
    assert {each.delay_s for each in found if each.kind == "prompt"} == {3.0}
    assert all(each.follows for each in responses(observed, "ra", Reactions(compliance=1.0)))
    assert not any(each.follows for each in responses(observed, "ra", Reactions(compliance=0.0)))


@examples(50)
@given(st.integers(0, 2**40), st.sampled_from(get_args(Channel)))
def test_how_somebody_responds_is_the_same_for_all_revisions(seed: int, channel: Channel) -> None:
    model = ReactionModel("AAL123", RESPONSE_MODELS["observed"].crews, OWN, seed)
    kinds = {
        model.respond(channel, "d-1", revision=revision, is_vertical=True).kind
        for revision in range(5)
    }
    assert len(kinds) == 1


def test_each_channel_each_advisory_and_each_actor_has_a_draw_of_its_own() -> None:
    half = Channels(assistant=Responses(median_s=1.0, no_response=0.5))
    names: list[tuple[str, Channel, str]] = [
        ("AAL123", "ra", "d-1"),
        ("AAL123", "assistant", "d-1"),
        ("AAL123", "assistant", "d-2"),
        ("DAL456", "assistant", "d-1"),
    ]
    answers = [
        [ReactionModel(name, half, OWN, s).respond(channel, at).follows for s in range(40)]
        for name, channel, at in names
    ]
    assert all(one != other for i, one in enumerate(answers) for other in answers[:i])


def test_a_seed_does_not_make_the_same_people_fail_in_every_scenario() -> None:
    half = ResponseModel(
        crews=(coin := Channels(assistant=Responses(median_s=1.0, no_response=0.5))),
        drivers=coin,
        controllers=coin.assistant,
    )
    answers = {
        name: [
            reaction_models(scenario, seed)["AAL123"].respond("assistant", "d-1").follows
            for seed in range(40)
        ]
        for name in ("s02a_headon", "s02a_vertical")
        for scenario in [load(name).model_copy(update={"crews": half})]
    }
    assert answers["s02a_headon"] != answers["s02a_vertical"]


def test_who_goes_the_wrong_way_goes_as_far_the_other_way() -> None:
    flown = Response("opposite", 5.0).flown(DOWN, 35_000.0)
    assert (flown.sense, flown.altitude_ft, flown.vertical_rate_fpm) == ("climb", 35_600.0, 1500.0)


def test_who_is_too_slow_goes_to_the_level_at_a_part_of_the_rate() -> None:
    flown = Response("weak", 5.0, rate_factor=0.5).flown(DOWN, 35_000.0)
    assert (flown.sense, flown.altitude_ft, flown.vertical_rate_fpm) == ("descend", 34_400.0, 750.0)


def test_late_is_a_multiple_of_the_same_delay() -> None:
    prompt = ReactionModel("AAL123", Channels(assistant=Responses(median_s=5.0)), OWN, 1)
    late = Channels(assistant=Responses(median_s=5.0, late=1.0, late_factor=3.0))
    told = prompt.respond("assistant", "d-1")
    assert ReactionModel("AAL123", late, OWN, 1).respond("assistant", "d-1").delay_s == (
        pytest.approx(3.0 * told.delay_s)
    )
