"""A worker is a server in virtual time: it is as late as its model is slow."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.errors import WorkerError
from airhilt.sim import (
    Director,
    Input,
    Output,
    Priority,
    Reply,
    Server,
    Virtual,
    WorkerLost,
    parse_latency,
)
from airhilt.sim.latency import LatencySource, LatencySpec
from airhilt.sim.payload import DeferredBytes
from airhilt.sim.worker import Policy
from airhilt.units import SECOND_NS, seconds_to_ns


@dataclass
class Answer:
    """A step that is under way: ``reply`` may be what it raises."""

    reply: Reply | Exception

    def result(self) -> Reply:
        if isinstance(self.reply, Exception):
            raise self.reply
        return self.reply


@dataclass
class Bench:
    """One server with a worker that the test writes, and all that comes out of it."""

    answer: Callable[..., Any]
    latency: LatencySource
    name: str = "worker"
    director: Director = field(default_factory=lambda: Director(Virtual()))

    def __post_init__(self) -> None:
        self.calls: list[Any] = []
        self.out: list[tuple[int, bytes]] = []
        self.steps: list[Any] = []
        self.losses: list[Any] = []
        self.server = Server(
            self.name,
            self.director,
            cast(Any, self),
            self.latency,
            deliver=lambda output: self.out.append((self.director.now_ns, output.payload)),
            done=self.steps.append,
            lost=lambda cause, _: self.losses.append(cause),
        )

    def dispatch(self, seq: int, t_ns: int, inputs: tuple[Input]) -> Answer:
        self.calls.append((seq, t_ns, tuple(item.payload for item in inputs)))
        return Answer(self.answer(seq, t_ns, inputs))

    def offer_at(self, t_ns: int, payload: bytes, policy: Policy = "fifo", key: str = "k") -> Bench:
        def offer() -> None:
            self.server.offer(Input(key, t_ns, payload), policy)

        self.director.at(t_ns, offer, Priority.SENSOR)
        return self

    def run(self) -> Bench:
        self.director.run()
        return self


MEASURED = LatencySpec("measured").source("worker", 1, 0.0, 0.0)


def fixed(latency_ns: int) -> LatencySource:
    return LatencySpec("fixed", latency_ns / SECOND_NS).source("worker", 1, 0.0, 0.0)


def echo(seq: int, t_ns: int, inputs: tuple[Input]) -> Reply:
    return Reply(tuple(Output("out", item.payload) for item in inputs), compute_s=0.0)


def test_a_result_leaves_one_latency_after_the_start() -> None:
    bench = Bench(echo, fixed(30)).offer_at(100, b"a").run()
    assert bench.calls == [(0, 100, (b"a",))]
    assert bench.out == [(130, b"a")]
    (step,) = bench.steps
    assert (step.t_in_ns, step.t_start_ns, step.latency_ns) == (100, 100, 30)
    assert (step.outputs, step.finished) == (1, True)


@settings(deadline=None)
@given(
    st.lists(st.integers(0, 500), min_size=1, max_size=20),
    st.lists(st.integers(0, 60), min_size=20, max_size=20),
)
def test_an_input_starts_when_it_has_come_and_the_worker_is_free(
    arrivals: list[int], latencies: list[int]
) -> None:
    recorded = dict(enumerate(latencies))
    spec = parse_latency("replay:a")
    source = type(spec)("replay", replay_of="a", recorded={"worker": recorded}).source(
        "worker", 0, 0.0, 0.0
    )
    bench = Bench(echo, source)
    for number, t_ns in enumerate(sorted(arrivals)):
        bench.offer_at(t_ns, b"%d" % number)
    bench.run()

    expected, free_ns = [], 0
    for number, t_in_ns in enumerate(sorted(arrivals)):
        start_ns = max(t_in_ns, free_ns)
        free_ns = start_ns + latencies[number]
        expected.append((t_in_ns, start_ns, free_ns, b"%d" % number))
    assert [call[1:] for call in bench.calls] == [
        (start, (name,)) for _, start, _, name in expected
    ]
    assert bench.out == [(out, name) for _, _, out, name in expected]
    assert [step.t_in_ns for step in bench.steps] == [t_in for t_in, *_ in expected]


def test_latest_keeps_the_newest_of_each_key_and_counts_what_it_drops() -> None:
    bench = Bench(echo, fixed(10))
    for t_ns, name in ((0, b"a"), (1, b"b"), (2, b"c"), (3, b"d")):
        bench.offer_at(t_ns, name, "latest", key="left")
    bench.offer_at(2, b"other", "latest", key="right").run()
    assert [payload for _, payload in bench.out] == [b"a", b"d", b"other"]
    assert +bench.server.dropped == {"left": 2}


def test_an_input_without_a_payload_replaces_none_that_has_one_and_is_not_counted() -> None:
    bench = Bench(echo, fixed(10))
    for t_ns, payload in ((0, b"a"), (1, b""), (2, b"b"), (3, b""), (14, b""), (15, b"c")):
        bench.offer_at(t_ns, payload, "latest")
    bench.run()
    assert bench.out == [(10, b"a"), (20, b"b"), (30, b"c")]
    assert not bench.server.dropped.total()


def test_of_several_keys_that_are_too_fast_each_has_its_turn() -> None:
    bench = Bench(echo, fixed(10))
    for t_ns in range(0, 60, 6):
        for key in ("left", "right", "behind"):
            bench.offer_at(t_ns, key.encode(), "latest", key=key)
    bench.run()
    assert [payload for _, payload in bench.out] == [b"left", b"right", b"behind"] * 3


def test_a_batch_takes_all_batched_inputs_that_wait() -> None:
    bench = Bench(echo, fixed(10))
    for t_ns, name in ((0, b"a"), (1, b"b"), (2, b"c"), (12, b"d")):
        bench.offer_at(t_ns, name, "batch", key=name.decode())
    bench.run()
    assert [inputs for _, _, inputs in bench.calls] == [(b"a",), (b"b", b"c"), (b"d",)]


def test_inputs_of_one_instant_are_one_batch() -> None:
    bench = Bench(echo, fixed(10)).offer_at(5, b"a", "batch").offer_at(5, b"b", "batch").run()
    assert bench.calls == [(0, 5, (b"a", b"b"))]


def test_a_batch_leaves_the_unbatched_ones_in_the_queue() -> None:
    bench = Bench(echo, fixed(10))
    policies: tuple[tuple[bytes, Policy], ...] = (
        (b"a", "fifo"), (b"b", "batch"), (b"c", "fifo"), (b"d", "batch"),
    )  # fmt: skip
    for name, policy in policies:
        bench.offer_at(0, name, policy)
    bench.run()
    assert [inputs for _, _, inputs in bench.calls] == [(b"a",), (b"b", b"d"), (b"c",)]


def test_with_a_known_latency_the_world_goes_on_while_the_worker_computes() -> None:
    world = []

    class Watched(Answer):
        def result(self) -> Reply:
            world.append("collected")
            return super().result()

    bench = Bench(echo, fixed(10))
    bench.dispatch = lambda seq, t_ns, inputs: Watched(echo(seq, t_ns, inputs))
    bench.offer_at(0, b"a")
    bench.director.at(5, lambda: world.append("physics"), Priority.PHYSICS)
    bench.run()
    assert world == ["physics", "collected"]


def test_a_measured_latency_is_the_compute_time_that_the_reply_tells() -> None:
    bench = Bench(lambda *_: Reply((Output("out", b"x"),), compute_s=40e-9), MEASURED)
    bench.offer_at(100, b"a").offer_at(110, b"b").run()
    assert bench.out == [(140, b"x"), (180, b"x")]
    assert [step.latency_ns for step in bench.steps] == [40, 40]
    assert [step.t_start_ns for step in bench.steps] == [100, 140]


def test_measured_workers_of_an_instant_are_all_called_before_one_is_waited_for() -> None:
    order = []

    class Watched(Answer):
        def result(self) -> Reply:
            order.append("waited for")
            return super().result()

    def called(*_: Any) -> Answer:
        order.append("called")
        return Watched(Reply((), 0.0))

    director = Director(Virtual())
    for name in ("one", "two"):
        bench = Bench(echo, MEASURED, name=name, director=director)
        bench.dispatch = called  # type: ignore[assignment]
        bench.offer_at(5, b"a")
    director.run()
    assert order == ["called", "called", "waited for", "waited for"]


def test_results_of_one_instant_come_in_the_order_in_which_their_steps_began() -> None:
    director, published = Director(Virtual()), []
    benches = {
        name: Bench(echo, fixed(latency_ns), name=name, director=director)
        for name, latency_ns in (("slow", 90), ("quick", 40), ("quicker", 10))
    }
    for name, t_ns in (("slow", 0), ("quick", 50), ("quicker", 80)):
        benches[name].server._deliver = lambda _, n=name: published.append((director.now_ns, n))  # type: ignore[misc]
        benches[name].offer_at(t_ns, b"a")
    director.run()
    assert published == [(90, "slow"), (90, "quick"), (90, "quicker")]


def test_a_worker_is_woken_without_inputs_at_the_time_that_it_asked_for() -> None:
    def answer(seq: int, t_ns: int, inputs: tuple[Any, ...]) -> Reply:
        return Reply((), 0.0, wake_ns=500 if seq == 0 else None)

    bench = Bench(answer, fixed(10)).offer_at(100, b"a").run()
    assert bench.calls == [(0, 100, (b"a",)), (1, 500, ())]


def test_an_input_before_the_alarm_makes_the_worker_ask_anew() -> None:
    def answer(seq: int, t_ns: int, inputs: tuple[Input]) -> Reply:
        return Reply((), 0.0, wake_ns=500 if seq == 0 else None)

    bench = Bench(answer, fixed(10)).offer_at(100, b"a").offer_at(300, b"b").run()
    assert [t_ns for _, t_ns, _ in bench.calls] == [100, 300]


def test_an_alarm_that_has_passed_when_the_step_ends_rings_at_once() -> None:
    def answer(seq: int, t_ns: int, inputs: tuple[Any, ...]) -> Reply:
        return Reply((), 0.0, wake_ns=101 if seq == 0 else None)

    bench = Bench(answer, fixed(10)).offer_at(100, b"a").run()
    assert [t_ns for _, t_ns, _ in bench.calls] == [100, 110]


@pytest.mark.parametrize("wake_ns", [99, 100])
def test_an_alarm_no_later_than_its_step_is_refused(wake_ns: int) -> None:
    bench = Bench(lambda *_: Reply((), 0.0, wake_ns=wake_ns), fixed(10)).offer_at(100, b"a")
    with pytest.raises(WorkerError, match=rf"'worker' asked to be woken at {wake_ns} ns"):
        bench.run()


@pytest.mark.parametrize(
    ("t_out_ns", "leaves_ns"), [(None, 110), (100, 110), (110, 110), (150, 150)]
)
def test_an_output_leaves_no_earlier_than_the_latency_allows(
    t_out_ns: int | None, leaves_ns: int
) -> None:
    bench = Bench(lambda *_: Reply((Output("out", b"x", t_out_ns),), 0.0), fixed(10))
    bench.offer_at(100, b"a").run()
    assert bench.out == [(leaves_ns, b"x")]


def test_an_output_from_before_its_step_is_refused() -> None:
    bench = Bench(lambda *_: Reply((Output("asr/1", b"x", 99),), 0.0), fixed(10))
    bench.offer_at(100, b"a")
    with pytest.raises(WorkerError, match=r"'worker' sent 'asr/1' with t_out_ns 99.*at 100 ns"):
        bench.run()


@pytest.mark.parametrize("latency", [fixed(10), MEASURED])
def test_a_lost_worker_is_told_of_once_and_called_no_more(latency: LatencySource) -> None:
    def answer(seq: int, t_ns: int, inputs: tuple[Input]) -> Reply | WorkerLost:
        return WorkerLost("it died") if seq == 1 else echo(seq, t_ns, inputs)

    bench = Bench(answer, latency)
    for number in range(5):
        bench.offer_at(20 * number, b"%d" % number)
    bench.run()
    assert bench.losses == ["it died"]
    assert bench.server.is_lost
    assert len(bench.calls) == 2
    assert [payload for _, payload in bench.out] == [b"0"]


def test_what_waits_for_a_lost_worker_is_dropped_and_its_step_in_hand_gives_nothing() -> None:
    bench = Bench(echo, fixed(100)).offer_at(0, b"a").offer_at(10, b"b")
    bench.director.at(50, lambda: bench.server.lose("gone"), Priority.SCRIPT)
    bench.director.at(60, lambda: bench.server.lose("gone again"), Priority.SCRIPT)
    bench.offer_at(70, b"c").run()
    assert bench.losses == ["gone"]
    assert bench.out == []
    assert len(bench.calls) == 1


def test_what_reaches_a_lost_worker_does_not_count_as_dropped() -> None:
    bench = Bench(echo, fixed(100))
    bench.director.at(50, lambda: bench.server.lose("gone"), Priority.SCRIPT)
    for at_ns in (60, 70, 80):
        bench.offer_at(at_ns, b"frame", "latest")
    bench.run()
    assert not bench.server.dropped


def test_an_output_that_a_lost_worker_held_back_is_not_sent() -> None:
    bench = Bench(lambda *_: Reply((Output("out", b"x", 150),), 0.0), fixed(10)).offer_at(100, b"a")
    bench.director.at(120, lambda: bench.server.lose("gone"), Priority.SCRIPT)
    bench.run()
    assert len(bench.steps) == 1
    assert bench.out == []


def test_the_run_can_end_before_a_step_does() -> None:
    bench = Bench(echo, fixed(100)).offer_at(7, b"a")
    bench.director.at(50, bench.director.stop, Priority.OBSERVE)
    bench.run()
    step = bench.server.in_hand
    assert step is not None
    assert (step.t_start_ns, step.latency_ns, step.finished) == (7, 100, False)
    assert bench.steps == []


# --- latencies that depend on the input or on the result ------------------------------------


def test_what_has_lasted_counts_from_its_begin_also_while_it_waits() -> None:
    source = parse_latency("since_start:6").source("worker", 1, 0.0, 0.0)
    bench = Bench(echo, source)
    begun_ns, waited_ns = seconds_to_ns(1.0), seconds_to_ns(0.5)

    def offer(t_ns: int) -> None:
        item = Input("k", t_ns, b"call", None, begun_ns)
        bench.director.at(t_ns, lambda: bench.server.offer(item, "fifo"), Priority.SENSOR)

    offer(seconds_to_ns(4.0))
    offer(seconds_to_ns(4.0) + waited_ns)
    bench.run()
    first, second = bench.steps
    for step in (first, second):
        left_ns = source.known_ns(step.seq, step.t_start_ns - begun_ns)
        assert step.latency_ns == left_ns
    assert second.t_start_ns == first.t_start_ns + first.latency_ns


def test_a_step_without_outputs_leaves_a_worker_free_at_once() -> None:
    def loud_ones(seq: int, t_ns: int, inputs: tuple[Input]) -> Reply:
        return Reply(tuple(Output("out", i.payload) for i in inputs if i.payload == b"loud"), 0.0)

    source = parse_latency("on_output:0.4").source("worker", 1, 0.0, 0.0)
    bench = Bench(loud_ones, source)
    for t_ns, name in ((100, b"quiet"), (200, b"loud"), (300, b"quiet")):
        bench.offer_at(t_ns, name)
    bench.run()
    assert [(step.t_start_ns, step.latency_ns) for step in bench.steps] == [
        (100, 0), (200, 400_000_000), (400_000_200, 0),
    ]  # fmt: skip
    assert bench.out == [(400_000_200, b"loud")]


def test_an_input_whose_payload_is_made_later_can_be_sent_to_another_process() -> None:
    item = Input.of("camera/tower/frame", 5, DeferredBytes(6, lambda: b"pixels"), {"seq": 1})
    for copied in (copy.copy(item), pickle.loads(pickle.dumps(item))):
        assert (copied.payload, copied.size) == (b"pixels", 6)
        assert (copied.key, copied.t_in_ns, copied.attachment) == (item.key, 5, {"seq": 1})
