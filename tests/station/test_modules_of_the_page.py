"""Modules of the page by themselves: time, tracks, plots, lists, what is kept."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator, Sequence

import pytest

from airhilt.messages import Severity
from airhilt.metrics.summary import IsaRating, PersonReaction, PersonSummary, WorkloadSummary
from devtools import Page
from stations import ADVISORY, seat_page

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
        for (const kind of ['call', 'event', 'advisory'])
            run.apply(rows.map((row) => [kind, row]));
    }
    const kept = [run.calls, run.events, run.advisories].map((rows) => rows.length);
    return { most, kept, early: track.place(10000)[0], newest: run.calls.at(-1).id };
})"""


@pytest.fixture(scope="module")
def station(browser: Page) -> Iterator[Page]:
    """The page of a run, which is opened once: its modules are all that is asked."""
    with seat_page() as (_, url):
        browser.open(url)
        browser.wait_for("document.body.dataset.ready")
        yield browser


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


KEPT = """import(new URL('page/model.js', location)).then(({ Run }) => {
    const none = { tracks: [], calls: [], events: [], advisories: [], spoken: [], cameras: [] };
    const run = new Run({ ...none, scenario: { name: '' } });
    for (let i = 0; i < 2000; i += 1)
        run.apply([['state', `${i}`, 'aircraft', '', i, 0, 0, 1000, [1, 0], 90, false, '']]);
    return [run.tracks.length, Boolean(run.track('1999'))];
})"""


def test_the_actors_that_are_kept_of_a_run_have_a_bound(station: Page) -> None:
    assert station.evaluate(KEPT) == [200, True]


PLOTS = """import(new URL('page/model.js', location)).then(({ Run }) => {
    const none = { tracks: [], calls: [], events: [], advisories: [], spoken: [], cameras: [] },
        plot = (t, east) => ['plot', { t, kind: 'secondary', east, north: 0, turn_s: 4 }],
        state = (name, t, east) =>
            ['state', name, 'aircraft', '', t, east, 0, 1000, [0, 0], 90, false, ''],
        alone = (run, t) => run.plots.at(t).map(({ isAlone }) => isAlone);
    const run = new Run({ ...none, scenario: { name: '' } });
    run.apply([state('AAL123', 1, 0), plot(1, 100), plot(1, 9000)]);
    const settled = alone(run, 2);
    run.apply([state('DAL456', 3, 9100)]);
    const explained = alone(run, 3);
    run.apply([plot(100, 20000)]);
    return { settled, explained, older: alone(run, 10), newest: alone(run, 100) };
})"""
"""Plots that are alone at some times."""


LATE_PLOT = """import(new URL('page/radar_plots.js', location)).then(({ RadarPlots }) => {
    const plots = new RadarPlots();
    for (const t of [100, 20]) plots.add({ t, east: 0, north: 0, turn_s: 5 }, []);
    const before = plots.at(101).map(({ plot, isAlone }) => [plot.t, isAlone]);
    plots.explain({ last: 100, place: () => [0, 0] });
    return [before, plots.at(101).map(({ plot, isAlone }) => [plot.t, isAlone])];
})"""
"""The plots that are shown after an old one has come late, and once their actor is found."""


def test_an_old_plot_that_comes_late_hides_no_other(station: Page) -> None:
    assert station.evaluate(LATE_PLOT) == [[[100, True]], [[100, False]]]


def test_a_plot_is_alone_until_another_sensor_finds_its_actor(station: Page) -> None:
    assert station.evaluate(PLOTS) == {
        "settled": [False, True],
        "explained": [False, False],
        "older": [False, False],
        "newest": [True],
    }


LISTED_AT_ONCE = """Promise.all(['advisories', 'model', 'clock'].map((name) =>
    import(new URL(`page/${name}.js`, location)))).then(([{ Advisories }, { Run }, { Clock }]) => {
    const none = { tracks: [], calls: [], events: [], advisories: [], spoken: [] },
        run = new Run({ ...none, scenario: { name: '' } }),
        advisories = new Advisories(run, new Clock(0, true), {});
    run.apply([['advisory', %s]]);
    advisories.draw();
    return document.getElementById('advisories').innerText;
})"""


def test_an_advisory_is_listed_when_the_plan_shows_it(station: Page) -> None:
    assert "Both lose separation." in station.evaluate(LISTED_AT_ONCE % json.dumps(ADVISORY))


def test_an_actor_that_truth_and_surveillance_both_tell_of_is_one(
    station: Page,
) -> None:
    state = '["state", "{}", "aircraft", "", {}, 0, 0, 35000, [0, 200], 0, false, ""]'
    told = [state.format("a1b2c3", 1), state.format("AAL123", 2), '["name", "a1b2c3", "AAL123"]']
    names = station.evaluate(
        "import(new URL('page/model.js', location)).then(({ Run }) => {"
        "const run = new Run({ tracks: [], calls: [], spoken: [], events: [], advisories: [],"
        "scenario: { name: '' } });"
        f"run.apply([{', '.join(told)}]);"
        "return run.tracks.map((track) => track.callsign).join(); })"
    )
    assert names == "AAL123"


def test_what_people_perceived_did_and_answered_are_moments_of_the_debrief(
    station: Page,
) -> None:
    reaction = PersonReaction(
        advisory="a-1", revision=1, severity=Severity.WARNING, advised="go_around",
        t_advisory_s=10.0, t_seen_s=10.1, t_heard_s=10.5, voice_to_loudspeaker_s=0.1,
        first_action="go_around", reaction_time_s=1.5, followed=True,
    )  # fmt: skip
    shared = {"t_seen_s": None, "t_heard_s": 14.0, "reaction_time_s": None, "is_shared": True}
    person = PersonSummary(
        seat="AAL123", spoken_calls=0, typed_calls=0, commands=1, asked_to_say_again=0,
        press_to_transmit_s=None, reaction_time_s=1.5,
        reactions=[reaction, reaction.model_copy(update=shared)],
        workload=WorkloadSummary(
            isa_mean=4.0,
            isa=[
                IsaRating(t_s=20.0, rating=4, answered_after_s=2.0),
                IsaRating(t_s=40.0, rating=None, answered_after_s=None),
            ],
            nasa_tlx=None,
            raw_tlx=None,
        ),
    )  # fmt: skip
    given = {
        "tracks": [], "calls": [], "spoken": [], "advisories": [], "scenario": {"name": ""},
        "events": [
            {"t": 1.0, "kind": "seat", "who": "AAL123", "text": "a person has it"},
            {"t": 2.0, "kind": "pace", "who": "run", "text": "paused"},
        ],
        "summary": {"people": [person.model_dump(mode="json")]},
    }  # fmt: skip
    moments = station.evaluate(
        "import(new URL('page/model.js', location)).then(({ Run }) =>"
        f"new Run({json.dumps(given)}).moments.map(({{ t, text }}) => [t, text]))"
    )
    assert moments == [
        [1.0, "seat, AAL123, a person has it"],
        [2.0, "pace, run, paused"],
        [10.1, "AAL123 sees WARNING, go around"],
        [10.5, "AAL123 hears WARNING, go around"],
        [12.0, "AAL123 reacts to WARNING, go around: go around"],
        [14.0, "AAL123 hears WARNING, go around"],
        [22.0, "AAL123 answers: workload 4"],
        [40.0, "AAL123 does not answer for the workload"],
    ]


SOUNDS = """import(new URL('page/sounds.js', location)).then(({ Sounds }) => {
    const clock = { t: 0, rate: 1, playing: false },
        sounds = new Sounds({ sounds: ['119100', '119100@AAL123'] }, clock),
        shown = () => [...document.querySelectorAll('#sounds label')].map((one) =>
            [one.textContent, one.querySelector('input').checked]);
    const before = shown();
    sounds.mute();
    sounds.mute();
    return [before, shown()];
})"""


def test_what_a_seat_heard_by_its_own_receiver_is_off_until_it_is_switched_on(
    station: Page,
) -> None:
    at_first = [["119.100 MHz", True], ["119.100 MHz at AAL123", False]]
    assert station.evaluate(SOUNDS) == [at_first, at_first]


def test_a_page_is_linked_by_the_name_under_which_this_one_was_opened(station: Page) -> None:
    """A station that listens at all addresses does not know the name that others have for it."""
    linked = station.evaluate(
        "import(new URL('page/neighbours.js', location)).then(({ onThisHost }) =>"
        "onThisHost('https://machine.example:8421/?token=a', 'Ops 1'))"
    )
    assert linked == "https://127.0.0.1:8421/?token=a#Ops%201"
