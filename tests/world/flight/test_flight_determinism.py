"""The same seed gives the same flight, bit by bit, wherever and beside whatever it is flown."""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from airhilt.host import library
from airhilt.world.flight import Atmosphere
from flights import in_cruise, states
from paths import SUPPORT

AIR = Atmosphere(wind_north_m_s=5.0, turbulence_wind_at_20ft_m_s=15.0, turbulence_severity=4)
PROGRAM = """
import sys
from concurrent.futures import ThreadPoolExecutor
sys.path[:0] = {folders!r}
from test_flight_determinism import AIR, flight
print(repr(flight()))
"""


def flight(name: str = "737", seed: int = 7) -> tuple[float, ...]:
    aircraft = in_cruise(name, seed=seed, atmosphere=AIR)
    aircraft.en_route.turn_by(0.5)
    *_, last = states(aircraft, 20)
    return tuple(last)


def test_in_one_process(name: str) -> None:
    assert flight(name) == flight(name)


def test_another_seed_gives_another_flight() -> None:
    assert flight() != flight(seed=8)


def test_with_other_aircraft_flown_in_between() -> None:
    alone = flight()
    aircraft = in_cruise("737", seed=7, atmosphere=AIR)
    others = [in_cruise("B747", seed=3, atmosphere=AIR), in_cruise("737", seed=9, atmosphere=AIR)]
    aircraft.en_route.turn_by(0.5)
    for _ in states(aircraft, 20):
        for other in others:
            other.advance()
    assert tuple(aircraft.state) == alone


def test_in_another_process() -> None:
    program = PROGRAM.format(folders=[str(Path(__file__).parent), str(SUPPORT)])
    answer = subprocess.run(
        [sys.executable, "-c", program],
        cwd=Path(library.__file__).parents[1],
        capture_output=True,
        text=True,
        check=True,
    )
    assert answer.stdout == f"{flight()!r}\n"


def test_in_threads() -> None:
    with ThreadPoolExecutor(3) as threads:
        flights = [threads.submit(flight) for _ in range(3)]
    assert {one.result() for one in flights} == {flight()}
