"""The outcome of a run and its advisories, from what monitors say was so."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, cast, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt import load
from airhilt.messages import Advisory, Confirm, Evidence, GoAround, Severity
from airhilt.metrics.advisories import AdvisoryRecords
from airhilt.metrics.outcome import INFRINGEMENTS, SERIOUS, SEVEREST_FIRST, Outcome
from airhilt.metrics.summary import ConflictOutcome, RunwayIncursion
from airhilt.units import SECOND_NS
from airhilt.world.truth.conflicts import Approach, PairTruth
from breadth import examples

PAIR = ("AAL1", "DAL2")


def approach(horizontal_m: float, vertical_m: float = 0.0, t_s: float = 10.0) -> Approach:
    return Approach(round(t_s * SECOND_NS), horizontal_m, vertical_m)


def outcome(pairs: dict[Any, PairTruth], pair: Any = None, incursions: Any = None) -> Outcome:
    monitor = SimpleNamespace(pairs=pairs, flying=lambda _: True)
    runways = (
        None if incursions is None else SimpleNamespace(incursions=dict(enumerate(incursions)))
    )
    return Outcome(cast(Any, monitor), cast(Any, runways), pair)


def incursion(category: str = "A", user: Any = "AAL1", intruder: str = "DAL2",
              closest_m: float | None = 30.0) -> Any:  # fmt: skip
    closest = None if closest_m is None else SimpleNamespace(slant_m=closest_m)
    return SimpleNamespace(
        t_ns=5 * SECOND_NS, runway="01", user=user, intruder=intruder, category=category,
        closest=closest,
    )  # fmt: skip


def test_without_a_conflict_the_pair_that_came_nearest_counts() -> None:
    pairs = {
        ("A", "B"): PairTruth(closest=approach(900.0, t_s=10.0)),
        ("A", "C"): PairTruth(closest=approach(300.0, 400.0, t_s=20.0)),
        ("B", "C"): PairTruth(),
    }
    found = outcome(pairs).closest_approach
    assert found is not None
    assert (found.t_s, found.horizontal_m, found.vertical_m) == (20.0, 300.0, 400.0)
    assert outcome({("A", "B"): PairTruth()}).closest_approach is None
    assert outcome({}).closest_approach is None


def test_of_the_annotated_pair_the_approach_in_the_conflict_window_counts() -> None:
    truth = PairTruth(closest=approach(100.0), closest_in_window=approach(700.0, t_s=30.0))
    nearer = PairTruth(closest=approach(1.0))
    found = outcome({PAIR: truth, ("X", "Y"): nearer}, PAIR).closest_approach
    assert found is not None
    assert (found.t_s, found.horizontal_m) == (30.0, 700.0)
    assert outcome({PAIR: PairTruth(closest=approach(100.0))}, PAIR).closest_approach is None
    assert outcome({}, PAIR).pair_truth is None


@pytest.mark.parametrize(
    ("category", "names", "was_warned", "avoided"),
    [
        ("A", PAIR, True, False),
        ("B", PAIR, True, False),
        ("C", PAIR, True, True),
        ("C", PAIR, False, None),
        ("A", ("AAL1", "OPS1"), True, False),
        ("A", ("UAL3", "OPS1"), True, True),
    ],
)
def test_a_serious_incursion_of_one_of_the_pair_was_not_avoided(
    category: str, names: tuple[str, str], was_warned: bool, avoided: bool | None
) -> None:
    found = outcome({}, PAIR, [incursion(category, *names)])
    assert found.avoided(was_warned) is avoided
    assert found.came_about("runway_incursion") is (category in "AB" and names == PAIR)


def test_who_evades_one_aircraft_into_another_or_into_the_ground_has_avoided_nothing() -> None:
    pairs = {PAIR: PairTruth(), ("AAL1", "UAL3"): PairTruth(first_ns={"nmac": 1})}
    assert outcome(pairs, PAIR).conflict(True, True, True) == "lost"
    monitor = SimpleNamespace(pairs={}, flying=lambda _: False)
    crashed = Outcome(cast(Any, monitor), None, PAIR)
    assert crashed.conflict(was_warned=True, has_opened=True, is_credited=True) == "lost"


def test_a_collision_that_begins_the_conflict_is_no_outcome_of_it() -> None:
    (strike,) = load("s02b_bird_strike").causes
    pairs = {tuple(reversed(strike)): PairTruth(first_ns={"collision": 1})}
    found = Outcome(cast(Any, SimpleNamespace(pairs=pairs)), None, PAIR, [strike])
    assert not found.happened("collision")
    pairs[PAIR] = PairTruth(first_ns={"collision": 1})
    assert found.happened("collision")


def test_what_came_about_is_that_or_worse() -> None:
    lost = outcome({PAIR: PairTruth(first_ns={"nmac": 1})}, PAIR)
    assert lost.happened("nmac")
    assert not lost.happened("collision")
    assert lost.came_about("nmac")
    assert not lost.came_about("collision")
    assert lost.avoided(was_warned=True) is False


HARM = st.frozensets(st.sampled_from([*sorted(INFRINGEMENTS), "tcas_ta", "tcas_ra"]))
CATEGORIES = st.lists(
    st.tuples(
        st.sampled_from(SEVEREST_FIRST),
        st.sampled_from([PAIR, PAIR[::-1], ("AAL1", "OPS1"), (None, "DAL2")]),
    ),
    max_size=3,
)


@examples(6000)
@given(HARM, HARM, CATEGORIES, st.booleans(), st.booleans(), st.booleans(), st.booleans())
def test_every_timeline_has_one_outcome_by_its_harm_warning_and_window(
    phases: frozenset[str],
    elsewhere: frozenset[str],
    categories: list[tuple[str, Any]],
    has_pair: bool,
    was_warned: bool,
    is_credited: bool,
    has_opened: bool,
) -> None:
    """Who is credited was warned; harm to one of the pair counts, with whomever."""
    is_credited &= was_warned
    pairs = {
        names: PairTruth(first_ns=dict.fromkeys(cast(Any, found), 1))
        for names, found in ((PAIR, phases), (("AAL1", "OPS1"), elsewhere))
    }
    incursions = [incursion(category, *names) for category, names in categories]
    found = outcome(pairs if has_pair else {}, PAIR, incursions)
    harmed = (has_pair and not INFRINGEMENTS.isdisjoint(phases | elsewhere)) or any(
        category in SERIOUS and set(names) & {*PAIR} for category, names in categories
    )
    became = found.conflict(was_warned, has_opened, is_credited)
    holds = {
        "lost": harmed and was_warned,
        "missed": not was_warned and (harmed or has_opened),
        "avoided": not harmed and is_credited,
        "avoided_by_equipment": not harmed and was_warned and not is_credited,
        "no_conflict": not harmed and not was_warned and not has_opened,
    }
    assert [name for name, is_so in holds.items() if is_so] == [became]
    assert holds.keys() == set(get_args(ConflictOutcome))
    assert (found.avoided(is_credited) is True) is (became == "avoided")
    assert (found.avoided(is_credited) is False) is harmed


@pytest.mark.parametrize("was_warned", [False, True])
@pytest.mark.parametrize("has_opened", [False, True])
def test_what_equipment_averts_before_a_warning_is_no_merit_of_the_assistant(
    was_warned: bool, has_opened: bool
) -> None:
    found = outcome({PAIR: PairTruth()}, PAIR).conflict(was_warned, has_opened, is_credited=False)
    unwarned = "missed" if has_opened else "no_conflict"
    assert found == ("avoided_by_equipment" if was_warned else unwarned)


# --- advisories ---------------------------------------------------------------------------------


def advisory(**given: Any) -> Advisory:
    usual = {
        "t_ns": 100 * SECOND_NS, "t_ready_ns": 0, "id": "a", "revision": 0, "recipients": ("AAL1",),
        "kind": "runway_conflict",
        "severity": Severity.CAUTION, "recipient": "AAL1", "traffic": ("AAL1",),
        "evidence": Evidence(sources=("radio",)), "message": "x", "active": True,
    }  # fmt: skip
    return Advisory.model_validate(usual | given)


def records(
    pair: Any = PAIR,
    seen_ns: dict[str, int] | None = None,
    loss_s: float | None = None,
    shows: Callable[[], bool] = lambda: True,
) -> AdvisoryRecords:
    callsigns = {name: name for name in ("AAL1", "DAL2", "OPS1")} | {"abc123": "AAL1"}
    monitor = SimpleNamespace(time_to_loss_s=lambda _: loss_s)
    seen = seen_ns or {}
    return AdvisoryRecords(
        callsigns,
        pair,
        cast(Any, monitor),
        lambda name, since_ns: seen.get(name, -1) >= since_ns,
        lambda _: shows(),
    )


def test_a_warning_before_anything_of_the_conflict_shows_is_a_nuisance_to_the_pair() -> None:
    told = records(shows=lambda: False)
    told.add(advisory(traffic=PAIR))
    assert not told.warns_of_conflict(advisory(traffic=PAIR))
    assert told.nuisance_alerts([]) == 2


@pytest.mark.parametrize(
    ("traffic", "sources", "concerns"),
    [
        (PAIR, ("adsb",), True),
        (("AAL1", "DAL2", "OPS1"), ("adsb",), True),
        (("abc123", "DAL2"), ("adsb",), True),
        (("AAL1",), ("radio",), True),
        (("AAL1",), ("adsb",), False),
        (("AAL1", "unidentified"), ("radio",), True),
        (("AAL1", "OPS1"), ("radio",), False),
        (("unidentified",), ("radio",), False),
    ],
)
def test_an_advisory_concerns_the_pair_if_it_names_both_or_one_and_nobody_else(
    traffic: tuple[str, ...], sources: tuple[str, ...], concerns: bool
) -> None:
    told = advisory(traffic=traffic, evidence=Evidence(sources=sources))
    assert records().warns_of_conflict(told) is concerns


@pytest.mark.parametrize(("seen_s", "concerns"), [(90.0, True), (89.9, False), (None, False)])
def test_what_rests_on_cameras_must_have_been_seen_in_the_last_10_s(
    seen_s: float | None, concerns: bool
) -> None:
    seen = {} if seen_s is None else {"DAL2": round(seen_s * SECOND_NS)}
    told = advisory(evidence=Evidence(sources=("vision", "radio")))
    assert records(seen_ns=seen).warns_of_conflict(told) is concerns


@pytest.mark.parametrize(
    "changed",
    [{"active": False}, {"kind": "clarification"}, {"severity": Severity.ADVISORY},
     {"recipient": "UAL9"}],
)  # fmt: skip
def test_nobody_is_warned_by_what_is_over_asked_mild_or_for_a_stranger(
    changed: dict[str, Any],
) -> None:
    assert records().warns_of_conflict(advisory())
    assert records().warns_of_conflict(advisory(recipient="ATC"))
    assert not records().warns_of_conflict(advisory(**changed))


@pytest.mark.parametrize(
    ("loss_s", "pair", "count"),
    [(300.0, PAIR, 0), (301.0, PAIR, 2), (None, PAIR, 2), (10.0, None, 2)],
)
def test_a_loss_of_separation_within_5_min_is_no_nuisance(
    loss_s: float | None, pair: Any, count: int
) -> None:
    told = records(pair, loss_s=loss_s)
    told.add(advisory(kind="loss_of_separation", traffic=("AAL1", "OPS1"),
                      evidence=Evidence(sources=("adsb",))))  # fmt: skip
    assert told.nuisance_alerts([]) == count


def test_an_alert_about_an_incursion_or_the_pair_is_no_nuisance_and_a_question_none() -> None:
    real = RunwayIncursion(t_s=1.0, runway="01", user="AAL1", intruder="OPS1", category="C",
                           closest_m=None)  # fmt: skip
    told = records()
    told.add(advisory(id="a", traffic=PAIR))
    told.add(advisory(id="b", traffic=("AAL1", "OPS1"), evidence=Evidence(sources=("adsb",))))
    told.add(advisory(id="c", kind="clarification", traffic=("OPS1",)))
    told.add(advisory(id="d", traffic=("OPS1", "DAL2"), severity=Severity.ADVISORY))
    assert told.nuisance_alerts([real]) == 0
    assert told.nuisance_alerts([]) == 2
    assert told.clarifications() == 1
    assert [bool(each.nuisance_to) for each in told.summaries([])] == [False, True, False, False]


def test_an_alert_is_a_nuisance_to_each_whom_it_names_and_who_is_in_no_conflict() -> None:
    told = records()
    told.add(advisory(id="a", traffic=PAIR))
    told.add(advisory(id="a", revision=1, traffic=(*PAIR, "OPS1")))
    assert [each.nuisance_to for each in told.summaries([])] == [("OPS1",)]
    assert told.nuisance_alerts([]) == 1
    assert told.warns_of_conflict(advisory(traffic=(*PAIR, "OPS1")))


def test_each_revision_is_judged_by_what_any_recipient_was_told() -> None:
    told = records()
    assert told.add(advisory(severity=Severity.CAUTION))
    assert not told.add(advisory(severity=Severity.WARNING))
    assert told.add(advisory(revision=1, severity=Severity.ADVISORY, t_ns=120 * SECOND_NS))
    assert told.add(advisory(revision=2, severity=Severity.INFO, active=False))
    told.add_voice("a", 105 * SECOND_NS)
    told.add_voice("a", 125 * SECOND_NS)
    told.add_voice("b", 1)
    (summary,) = told.summaries([])
    assert (summary.t_first_s, summary.t_spoken_s) == (100.0, 105.0)
    assert (summary.severity, summary.revisions) == (Severity.WARNING, 3)


def test_an_alert_behind_a_mild_copy_of_it_is_an_alert() -> None:
    told = records(None)
    told.add(advisory(kind="clarification", recipient="ATC", severity=Severity.INFO))
    told.add(advisory(kind="clarification", severity=Severity.WARNING,
                      recommendation=GoAround(runway="01")))  # fmt: skip
    assert told.nuisance_alerts([])
    assert not told.clarifications()


def test_an_alert_counts_anew_each_time_that_it_comes_again() -> None:
    told = records(None)
    for second in range(6):
        told.add(advisory(revision=second, traffic=("OPS1",), active=second % 2 == 0))
    assert told.nuisance_alerts([]) == 3
    assert [each.nuisance_to for each in told.summaries([])] == [("OPS1",)]


def test_what_is_told_before_a_conflict_shows_is_not_excused_by_what_is_told_after() -> None:
    begun: list[bool] = []
    told = records(shows=lambda: bool(begun))
    told.add(advisory(traffic=PAIR))
    begun.append(True)
    told.add(advisory(revision=1, traffic=PAIR))
    assert told.nuisance_alerts([]) == 2


def test_a_bystander_who_is_told_to_act_is_disturbed_though_not_named() -> None:
    told = records()
    told.add(advisory(traffic=PAIR))
    told.add(advisory(traffic=PAIR, recipient="OPS1", recommendation=GoAround(runway="01")))
    told.add(advisory(traffic=PAIR, recipient="ATC", revision=1,
                      recommendations={"OPS1": GoAround(runway="01")}))  # fmt: skip
    assert [each.nuisance_to for each in told.summaries([])] == [("OPS1",)]


@pytest.mark.parametrize(
    ("told", "counts"),
    [(Confirm(callsign="AAL1", slot="runway"), False), (GoAround(runway="01"), True)],
)
def test_a_question_is_one_only_if_it_tells_nobody_what_to_do(told: Any, counts: bool) -> None:
    given = records(None)
    given.add(advisory(kind="clarification", severity=Severity.WARNING, recommendation=told))
    assert bool(given.nuisance_alerts([])) is counts
    assert given.clarifications() == (not counts)


def test_a_question_that_becomes_an_alert_was_none() -> None:
    given = records(None)
    given.add(advisory(kind="clarification"))
    given.add(advisory(revision=1, severity=Severity.WARNING))
    assert given.nuisance_alerts([])
    assert not given.clarifications()
