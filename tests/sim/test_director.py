"""Events run in the order of simulation time, whatever the order in which they were scheduled."""

from __future__ import annotations

import threading
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.sim import Director, Pace, Paused, Priority, RealTime, Virtual

events = st.lists(st.tuples(st.integers(0, 20), st.sampled_from(Priority)), max_size=40)


@settings(deadline=None)
@given(events)
def test_events_run_by_time_then_priority_then_order_of_scheduling(plan: list[Any]) -> None:
    director, ran = Director(Virtual()), []
    for number, (t_ns, priority) in enumerate(plan):
        director.at(t_ns, lambda n=number: ran.append((director.now_ns, n)), priority)  # type: ignore[misc]
    director.run()
    due = sorted(range(len(plan)), key=lambda n: (*plan[n], n))
    assert ran == [(plan[n][0], n) for n in due]


@settings(deadline=None)
@given(events, st.lists(st.integers(0, 20), max_size=5).map(sorted))
def test_a_run_in_steps_runs_the_events_of_a_whole_run(plan: list[Any], stops: list[int]) -> None:
    director, ran = Director(Virtual()), []
    for number, (t_ns, priority) in enumerate(plan):
        director.at(t_ns, lambda n=number: ran.append((director.now_ns, n)), priority)  # type: ignore[misc]
    for stop_ns in stops:
        goes_on = director.run(stop_ns)
        assert goes_on == any(t_ns > stop_ns for t_ns, _ in plan)
        assert {number for _, number in ran} == {
            number for number, (t_ns, _) in enumerate(plan) if t_ns <= stop_ns
        }
    assert not director.run()
    due = sorted(range(len(plan)), key=lambda n: (*plan[n], n))
    assert ran == [(plan[n][0], n) for n in due]


@settings(deadline=None)
@given(st.lists(st.integers(0, 5), min_size=1, max_size=30))
def test_time_never_runs_backwards_when_events_schedule_events(delays: list[int]) -> None:
    director, times, left = Director(Virtual()), [], list(delays)

    def act() -> None:
        times.append(director.now_ns)
        for _ in range(2):
            if left:
                director.at(director.now_ns + left.pop(), act, Priority.SCRIPT)

    director.at(0, act, Priority.SCRIPT)
    director.run()
    assert len(times) == len(delays) + 1
    assert times == sorted(times)


def test_an_event_of_this_instant_may_be_scheduled_while_the_instant_runs() -> None:
    director, ran = Director(Virtual()), []

    def sensor() -> None:
        ran.append("sensor")
        director.at(director.now_ns, lambda: ran.append("physics"), Priority.PHYSICS)

    director.at(5, sensor, Priority.SENSOR)
    director.at(5, lambda: ran.append("observe"), Priority.OBSERVE)
    director.run()
    assert ran == ["sensor", "physics", "observe"]


def test_a_time_that_is_no_int_is_refused() -> None:
    director = Director(Virtual())
    with pytest.raises(TypeError, match=r"event at 0.5 ns; expected an int"):
        director.at(0.5, lambda: None, Priority.SCRIPT)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"event at 0.5 ns; expected an int"):
        director.every(1, lambda: None, Priority.SCRIPT, first_ns=0.5)  # type: ignore[arg-type]


def test_an_event_in_the_past_is_refused_and_says_what_time_it_is() -> None:
    director = Director(Virtual())

    def act() -> None:
        with pytest.raises(ValueError, match=r"event at 9 ns, but it is already 10 ns"):
            director.at(9, lambda: None, Priority.SCRIPT)

    director.at(10, act, Priority.SCRIPT)
    director.run()
    assert director.now_ns == 10


def test_every_repeats_at_its_period_from_its_first_time() -> None:
    director, times = Director(Virtual()), []
    director.every(30, lambda: times.append(director.now_ns), Priority.PHYSICS, first_ns=10)
    director.at(100, director.stop, Priority.OBSERVE)
    director.run()
    assert times == [10, 40, 70, 100]


@pytest.mark.parametrize("period_ns", [0, -1])
def test_every_needs_a_positive_period(period_ns: int) -> None:
    with pytest.raises(ValueError, match="must be positive"):
        Director(Virtual()).every(period_ns, lambda: None, Priority.PHYSICS)


def test_stop_ends_the_run_after_the_event_in_hand() -> None:
    director, ran = Director(Virtual()), []

    def stop() -> None:
        director.stop()
        ran.append("first")

    director.at(1, stop, Priority.SCRIPT)
    director.at(1, lambda: ran.append("second"), Priority.SCRIPT)
    director.run()
    assert ran == ["first"]


def test_what_is_posted_runs_before_the_next_event() -> None:
    director, ran = Director(Virtual()), []

    def act() -> None:
        director.post(lambda: ran.append(("posted", director.now_ns)))

    director.at(5, act, Priority.SCRIPT)
    director.at(9, lambda: ran.append(("event", director.now_ns)), Priority.SCRIPT)
    director.run()
    (posted, posted_ns), event = ran
    assert posted == "posted"
    assert 5 <= posted_ns < 9
    assert event == ("event", 9)


def test_what_is_posted_never_runs_among_the_events_of_one_instant() -> None:
    director, ran = Director(Virtual()), []
    director.at(5, lambda: director.post(lambda: ran.append("posted")), Priority.PHYSICS)
    director.at(5, lambda: ran.append("observed"), Priority.OBSERVE)
    director.at(99, lambda: ran.append("later"), Priority.PHYSICS)
    director.run()
    assert ran == ["observed", "posted", "later"]


def test_a_post_from_another_thread_runs_in_the_thread_of_the_director() -> None:
    director, ran = Director(Virtual()), []

    def post() -> None:
        for number in range(100):
            director.post(lambda n=number: ran.append((n, threading.get_ident())))  # type: ignore[misc]
        director.post(director.stop)

    poster = threading.Thread(target=post)
    director.at(0, poster.start, Priority.SCRIPT)
    director.every(1_000, lambda: None, Priority.PHYSICS)
    director.run()
    poster.join()
    assert ran == [(number, threading.get_ident()) for number in range(100)]


def test_a_post_wakes_a_director_that_waits_for_the_wall_clock() -> None:
    director = Director(RealTime())
    in_an_hour, posted_ns = 3_600_000_000_000, []

    def posted() -> None:
        posted_ns.append(director.now_ns)
        director.stop()

    director.at(in_an_hour, lambda: None, Priority.SCRIPT)
    runner = threading.Thread(target=director.run, daemon=True)
    runner.start()
    director.post(posted)
    runner.join(timeout=30.0)
    assert not runner.is_alive()
    assert 0 <= posted_ns[0] < in_an_hour


def test_a_pause_that_leaves_no_room_before_the_next_event_can_be_ended() -> None:
    director = Director(Virtual())

    def pause_and_go_on() -> None:
        for pace in (Paused(), Virtual()):
            director.post(lambda pace=pace: director.change_pace(pace))  # type: ignore[misc]

    director.at(5, pause_and_go_on, Priority.SCRIPT)
    director.at(7, lambda: None, Priority.SCRIPT)
    director.at(99, director.stop, Priority.SCRIPT)
    director.run()
    assert director.now_ns == 99


def test_the_pace_may_change_while_it_runs() -> None:
    director, times = Director(RealTime()), []
    in_an_hour = 3_600_000_000_000
    director.at(0, lambda: director.change_pace(Virtual()), Priority.SCRIPT)
    director.at(in_an_hour, lambda: times.append(director.now_ns), Priority.SCRIPT)
    director.run()
    assert times == [in_an_hour]


def test_results_of_an_instant_arrive_before_workers_start_in_it() -> None:
    director, seen = Director(Virtual()), []
    for priority in reversed(Priority):
        director.at(5, lambda name=priority.name: seen.append(name), priority)  # type: ignore[misc]
    director.run()
    assert seen == ["PHYSICS", "SCRIPT", "SENSOR", "RESULT", "START", "SETTLE", "OBSERVE"]


class ClockedPace(Virtual):
    """A pace whose clock goes on only where the test says so."""

    def __init__(self) -> None:
        self.clock_ns = 0
        self._origin_ns = 0

    def start(self, t_ns: int) -> None:
        """Take the present instant as a simulation time."""
        self._origin_ns = t_ns - self.clock_ns

    def elapsed_ns(self, now_ns: int) -> int:
        """Return the simulation time by the clock."""
        return max(now_ns, self._origin_ns + self.clock_ns)


@pytest.mark.parametrize(("stall_ns", "lost_ns"), [(1000, []), (5000, [4990])])
def test_a_director_that_loses_time_does_not_make_up_for_a_stall(
    stall_ns: int, lost_ns: list[int]
) -> None:
    """Posted actions that wait when the stall is over come after it, and before the next event."""
    director, told = Director(pace := ClockedPace()), list[Any]()

    def stall() -> None:
        pace.clock_ns += stall_ns
        director.post(lambda: told.append(("posted", director.now_ns)))

    director.lose_time(1000, lambda ns: told.append(("lost", ns)))
    director.at(10, stall, Priority.SCRIPT)
    director.at(20, lambda: told.append(("behind", director.behind_ns)), Priority.SCRIPT)
    director.run()
    behind = ("behind", 0 if lost_ns else stall_ns - 20)
    posted_ns = 12 if lost_ns else 19
    assert told == [*(("lost", ns) for ns in lost_ns), ("posted", posted_ns), behind]


class LatePace(Virtual):
    """A pace whose clock is three seconds ahead of the events."""

    def elapsed_ns(self, now_ns: int) -> int:
        """Return the simulation time by the clock."""
        return now_ns + 3_000_000_000


@pytest.mark.parametrize(
    ("pace", "behind_ns"), [(LatePace(), 3_000_000_000), (Virtual(), 0), (Paused(), 0)]
)
def test_a_director_knows_by_how_much_its_events_are_behind_the_clock(
    pace: Pace, behind_ns: int
) -> None:
    assert Director(pace).behind_ns == behind_ns
