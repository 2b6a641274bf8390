"""The page of a live run between two messages, and the part of the run that it keeps."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import pytest

from devtools import Page
from stations import seat_page

pytestmark = pytest.mark.browser
FRAMES = """import(new URL('page/live_time.js', location)).then(({ LiveTime }) => {
    const time = new LiveTime(), shown = [];
    const messages = %s;
    for (let now = 0; now < %d; now += 16) {
        while (messages.length && messages[0][0] <= now) time.arrived(messages.shift()[1], now);
        shown.push(time.at(now));
    }
    return shown;
})"""
TOLD = """import(new URL('page/clock.js', location)).then(async ({ Clock }) => {
    const clock = new Clock(0, true), pass = (ms) => new Promise((done) => setTimeout(done, ms));
    let told = null;
    clock.listen(({ t }) => { told = t; });
    for (const end of [1, 20]) {
        clock.setEnd(end);
        await pass(600);
    }
    await pass(1500);
    return { told, shown: clock.t };
})"""
TRACK = """import(new URL('page/model.js', location)).then(({ LiveTrack }) => {
    const track = new LiveTrack('AAL123', 'aircraft', '', 0);
    for (const t of [0, 0.5, 1]) track.add([t, 100 * t, 0, 1000, [100, 0], 90, false, '']);
    return [0.75, 1, 1.5, 60].map((t) => track.state(t, 1).east);
})"""

RATES = """import(new URL('page/model.js', location)).then(({ LiveTrack }) => {
    const fly = (reported) => {
        const track = new LiveTrack('AAL123', 'aircraft', '', 0), rates = [];
        for (let t = 0; t <= 120; t += 1) {
            const altitude = Math.round((3000 - (700 / 60) * t) / 25) * 25;
            track.add([t, 70 * t, 0, altitude, [70, 0, ...reported], 90, false, '']);
            rates.push(track.state(t + 0.5, 1).rate);
        }
        return rates.slice(10);
    };
    return { reported: fly([-704]), mean: fly([]) };
})"""

TICKS = """import(new URL('page/profile.js', location)).then(({ timeTicks }) =>
    [0, 0.7, 2, 3, 3000].map((end) => timeTicks(end, 5).map(({ label }) => label)))"""

LONG = """import(new URL('page/model.js', location)).then(({ LiveTrack, Run }) => {
    const none = { tracks: [], calls: [], events: [], advisories: [], spoken: [] };
    const run = new Run({ ...none, scenario: { name: '' } });
    const track = new LiveTrack('AAL123', 'aircraft', '', 0);
    let most = 0;
    for (let t = 0; t < 40000; t += 0.5) {
        track.add([t, t, 0, 1000, [1, 0], 90, false, '']);
        most = Math.max(most, track.t.length);
    }
    for (let i = 0; i < 9000; i += 100) {
        const rows = [];
        for (let j = i; j < i + 100; j += 1) rows.push({ id: `${j}`, from: j, to: j, t: j });
        for (const kind of ['call', 'event', 'advisory', 'spoken'])
            run.apply(rows.map((row) => [kind, row]));
    }
    const kept = [run.calls, run.events, run.advisories, run.spoken].map((rows) => rows.length);
    return { most, kept, early: track.place(10000)[0], newest: run.calls.at(-1).id };
})"""


@pytest.fixture(scope="module")
def opened(browser: Page) -> Iterator[None]:
    """The page of a run, which is opened once: its modules are all that is asked."""
    with seat_page() as (_, url):
        browser.open(url)
        browser.wait_for("document.body.dataset.ready")
        yield
        browser.open("about:blank")


@pytest.fixture
def station(page: Page, opened: None) -> Page:
    return page


def frames(page: Page, messages: Sequence[tuple[float, float]], until_ms: int) -> list[float]:
    """Return the times shown in frames of 16 ms, with messages of (wall time in ms, run time)."""
    shown: list[float] = page.evaluate(FRAMES % ([list(one) for one in messages], until_ms))
    return shown


def test_the_time_shown_passes_evenly_though_messages_do_not(station: Page) -> None:
    messages = [(ms + 60 * (ms // 100 % 3), ms / 1000) for ms in range(0, 6000, 100)]
    shown = frames(station, messages, 6000)
    steps = [after - before for before, after in itertools.pairwise(shown)][200:]
    assert min(steps) > 0.012
    assert max(steps) < 0.020
    assert shown[-1] == pytest.approx(5.9, abs=0.15)


def test_the_time_shown_stands_soon_after_the_last_message(station: Page) -> None:
    shown = frames(station, [(ms, ms / 1000) for ms in range(0, 3100, 100)], 9000)
    assert 3.0 <= shown[-1] <= 3.51
    assert shown[-300:] == [shown[-1]] * 300


def test_lists_are_told_the_time_shown_though_no_message_comes_any_more(station: Page) -> None:
    found = station.evaluate(TOLD)
    assert found["told"] == found["shown"]
    assert found["told"] >= 20.0


def test_the_time_shown_jumps_to_a_run_that_is_far_ahead(station: Page) -> None:
    shown = frames(station, [(0, 0.0), (100, 0.1), (200, 500.0)], 300)
    assert shown[-1] >= 500.0


def test_an_actor_goes_on_for_one_and_a_half_intervals_after_its_last_report(
    station: Page,
) -> None:
    assert station.evaluate(TRACK) == [75, 100, 150, 100 + 0.75 * 100]


def test_the_vertical_rate_of_a_steady_approach_is_steady(station: Page) -> None:
    """Altitudes come in steps of 25 ft."""
    rates = station.evaluate(RATES)
    assert set(rates["reported"]) == {-704}
    assert max(abs(rate + 700) for rate in rates["mean"]) <= 150


def test_what_is_kept_of_a_long_run_has_a_bound(station: Page) -> None:
    found = station.evaluate(LONG)
    assert found["most"] <= 3600
    assert max(found["kept"]) <= 2400
    assert found["early"] == pytest.approx(10000)
    assert found["newest"] == "8999"


def test_no_two_ticks_of_the_time_axis_have_the_same_label(station: Page) -> None:
    assert station.evaluate(TICKS) == [
        ["0.0 s"],
        ["0.0 s", "0.2 s", "0.4 s", "0.6 s"],
        ["0.0 s", "0.5 s", "1.0 s", "1.5 s", "2.0 s"],
        ["0 s", "1 s", "2 s", "3 s"],
        ["0 s", "1,000 s", "2,000 s", "3,000 s"],
    ]
