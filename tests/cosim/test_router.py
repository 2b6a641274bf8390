"""Messages that are published once are answered later, to who comes late."""

from __future__ import annotations

from contextlib import closing
from typing import Any

from airhilt.bus.session import Bus, connect_client
from airhilt.cosim.router import MessageRouter
from airhilt.messages import RadarInfo

RADAR = RadarInfo(
    site="ASR", kind="terminal", latitude_deg=38.85, longitude_deg=-77.04, altitude_m=20.0,
    rotation_s=4.8, primary_range_m=100_000.0, secondary_range_m=200_000.0, t_ns=0,
)  # fmt: skip


class NoLog:
    """A log that keeps nothing."""

    def write(self, *_: Any) -> None:
        """Do nothing."""


def test_who_comes_late_asks_where_a_radar_is() -> None:
    with closing(Bus("run")) as bus:
        MessageRouter(bus, NoLog()).publish("radar/ASR/info", RADAR)  # type: ignore[arg-type]
        with closing(connect_client(bus.endpoint, 10.0)) as late:
            answers = [reply.ok for reply in late.get(f"{bus.prefix}/radar/*/info", timeout=2.0)]
    (answer,) = answers
    assert answer is not None
    assert answer.payload.to_bytes() == RADAR.model_dump_json().encode()
