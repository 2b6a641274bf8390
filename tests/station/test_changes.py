"""The changes of a run, as browsers get them that come at any time."""

from __future__ import annotations

import json

from hypothesis import given
from hypothesis import strategies as st

from airhilt.station.audiences import EVERYBODY, NOBODY, Audience
from airhilt.station.changes import MOST_AT_ONCE, Changes

PLACES = st.integers(min_value=0, max_value=80)


@given(st.integers(1, 60), st.integers(0, 80), PLACES, st.none() | PLACES)
def test_a_browser_gets_what_is_kept_from_a_number_on_up_to_another(
    most: int, count: int, number: int, end: int | None
) -> None:
    changes = Changes(most)
    for index in range(count):
        changes.add("event", index, "two\nlines", audience=NOBODY if index % 3 else EVERYBODY)
    everything = changes.since(0, admits=lambda _: True)
    kept = [] if everything is None else [change[1] for change in json.loads(everything.changes)]
    assert kept == [*range(count)][-len(kept) :] if kept else count == 0
    assert min(most, count) <= len(kept) <= most + most // 10 + 1
    batch = changes.since(number, end, admits=lambda audience: audience == EVERYBODY)
    wanted = [index for index in kept if index >= number and (end is None or index < end)]
    assert (batch is not None) == bool(wanted)
    if batch is not None:
        expected = [["event", index, "two\nlines"] for index in wanted if not index % 3]
        assert json.loads(batch.changes) == expected
        assert batch.next_number == wanted[-1] + 1


def test_a_late_browser_gets_a_long_run_in_several_messages() -> None:
    changes = Changes()
    count = 2 * MOST_AT_ONCE + 1
    for index in range(count):
        changes.add("state", index)
    found: list[int] = []
    number = 0
    while (batch := changes.since(number)) is not None:
        found += [change[1] for change in json.loads(batch.changes)]
        assert batch.next_number <= number + MOST_AT_ONCE
        number = batch.next_number
    assert found == [*range(count)]
    assert changes.next_number == count


def test_each_change_keeps_its_own_audience_when_it_is_old() -> None:
    changes = Changes()
    for index in range(5_000):
        changes.add("state", index, audience=Audience("adsb", f"{index % 7:06x}"))
    own = Audience("adsb", "000003")
    batch = changes.since(0, admits=lambda audience: audience == own)
    assert batch is not None
    assert [change[1] for change in json.loads(batch.changes)] == [*range(3, 5_000, 7)]
