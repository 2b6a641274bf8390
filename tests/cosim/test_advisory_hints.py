"""The author of a worker is told of warnings on which nobody acts."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from airhilt import Scenario, run
from airhilt.cosim.notices import WorkerNotices
from airhilt.cosim.replay import replay
from airhilt.messages import (
    UNREGISTERED,
    Advisory,
    Evidence,
    HoldPosition,
    InputSpec,
    Severity,
    Turn,
    WorkerDescription,
)
from airhilt.sim import Input, Output
from airhilt.workers import Step
from airhilt.world.actors import build_actors
from airhilt.world.site import ScenarioSite
from nominal import nominal
from notices import Notices

SEE = "see docs/workers.md#what-makes-somebody-act"
TURN, HOLD = Turn(degrees=30.0), HoldPosition(runway="01")


def advisory(recipient: str, recommendation: Any = None, **other: Any) -> Advisory:
    given: dict[str, Any] = {"severity": Severity.WARNING, "revision": 0} | other
    return Advisory(
        id="mine-1", recipient=recipient, recipients=(recipient,), kind="loss_of_separation",
        traffic=("AAL123",), message="", recommendation=recommendation,
        evidence=Evidence(sources=("adsb",)), t_ready_ns=0, **given,
    )  # fmt: skip


@pytest.fixture(scope="module")
def actors() -> dict[str, Any]:
    scenario = nominal("s01b_nominal")
    return build_actors(scenario, ScenarioSite.of(scenario), 0, 0.05)


def notices(actors: dict[str, Any], *advisories: Advisory, publisher: str = "mine") -> list[str]:
    texts: list[str] = []
    hints = WorkerNotices(actors, ("decision",), texts.append)
    for each in advisories:
        hints.take(publisher, each)
    return texts


def crew_of(actors: dict[str, Any]) -> Any:
    return next(each.spec for each in actors.values() if each.category == "aircraft")


@pytest.mark.parametrize(
    ("recipient", "recommendation", "words"),
    [
        ("OPS1", None, "its WARNING to OPS1 has no recommendation: nobody acts on it"),
        (
            "OPS1",
            TURN,
            "its WARNING to OPS1 recommends turn, which OPS1 does not follow: nobody acts on it",
        ),
        (
            "OPS9",
            TURN,
            "its WARNING to OPS9: nobody has that name, so nobody acts on it; expected a callsign "
            "or ATC",
        ),
    ],
)
def test_a_warning_on_which_nobody_acts_is_noticed(
    actors: dict[str, Any], recipient: str, recommendation: Any, words: str
) -> None:
    told = advisory(recipient, recommendation)
    assert notices(actors, told) == [f"worker 'mine': {words}; {SEE}"]


def test_a_worker_is_told_once(actors: dict[str, Any]) -> None:
    assert len(notices(actors, advisory("OPS1"), advisory("OPS9"))) == 1


def test_a_program_is_told_as_well(actors: dict[str, Any]) -> None:
    (text,) = notices(actors, advisory("OPS1"), publisher=UNREGISTERED)
    assert text.startswith("a program: its WARNING to OPS1")


def test_the_reference_worker_is_not_told(actors: dict[str, Any]) -> None:
    assert notices(actors, advisory("OPS1"), publisher="decision") == []


def test_what_is_in_order_is_not_noticed(actors: dict[str, Any]) -> None:
    crew = crew_of(actors)
    assert not notices(
        actors,
        advisory("ATC"),
        advisory("OPS1", HOLD),
        advisory(crew.callsign, TURN),
        advisory(crew.icao24, TURN),
        advisory("OPS1", severity=Severity.ADVISORY),
        advisory("OPS1", active=False),
    )


class WarnsOnly:
    """Warns a crew, and recommends nothing."""

    description = WorkerDescription(
        name="mine", modality="decision", inputs=(InputSpec(key="adsb/*", policy="batch"),)
    )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Return the same advisory each time."""
        told = advisory("AAL123")
        return Step((Output("advisory/AAL123", told.model_dump_json().encode()),))


def test_a_run_tells_it_once_and_its_replay_does_not(encounter: Scenario, tmp_path: Path) -> None:
    observer = Notices()
    short = encounter.model_copy(update={"duration_s": 4.0})
    options: Any = {"latency": "fixed", "speech": False, "cameras": False, "observer": observer}
    folder = run(short, out=tmp_path / "run", workers=[WarnsOnly()], **options).folder
    (text,) = observer.texts
    assert text.startswith("worker 'mine': its WARNING to AAL123 has no recommendation")
    repeated = Notices()
    assert replay(folder, observer=repeated).identical
    assert repeated.texts == []


def test_a_run_with_the_reference_assistant_tells_nothing(
    encounter: Scenario, tmp_path: Path
) -> None:
    observer = Notices()
    run(encounter, out=tmp_path / "run", latency="fixed", speech=False, observer=observer)
    assert observer.texts == []
