"""A decision program in plain Zenoh. It imports nothing of AIRHILT and takes no time grants.

    airhilt cosim --scenario s02a_headon --endpoint tcp/127.0.0.1:7447 --attach plain
    python examples/plain_zenoh_worker.py tcp/127.0.0.1:7447

Start the two in either order. Because the program takes no grants, the run goes by the wall clock,
and an advisory counts when it arrives. As soon as two aircraft are at the same level, the program
tells one crew to climb and the other to descend, and tells the controller of both.
"""

import json
import sys
import time
from typing import Any

import zenoh

config = zenoh.Config()
config.insert_json5("mode", '"client"')
config.insert_json5("connect/endpoints", json.dumps([sys.argv[1]]))
config.insert_json5("connect/timeout_ms", "60000")  # wait a minute for the run to come up
config.insert_json5("scouting/multicast/enabled", "false")
session = zenoh.open(config)
while not (answers := [reply.ok for reply in session.get("airhilt/*/clock") if reply.ok]):
    time.sleep(0.1)
answer = answers[0]
prefix = str(answer.key_expr).removesuffix("/clock")
reports: dict[str, dict[str, Any]] = {}
warned: list[int] = []


def receive(sample: zenoh.Sample) -> None:
    report = json.loads(sample.payload.to_bytes())
    if report["altitude_ft"] is None or report["callsign"] is None:
        return  # both arrive within the first seconds
    reports[report["icao24"]] = report
    pair = sorted(reports.values(), key=level)
    if len(pair) == 2 and level(pair[1]) - level(pair[0]) < 1000 and not warned:
        warned.append(report["t_adsb_out_ns"])
        traffic = [lower, upper] = [each["callsign"] for each in pair]
        warn(lower, traffic, climb("descend", level(pair[0]) - 1000))
        warn(upper, traffic, climb("climb", level(pair[1]) + 1000))
        warn("ATC", traffic, None)


def level(report: dict[str, Any]) -> float:
    return float(report["altitude_ft"])


def climb(sense: str, altitude_ft: float) -> dict[str, Any]:
    rate = {"vertical_rate_fpm": 1500}
    return {"action": "altitude", "sense": sense, "altitude_ft": altitude_ft} | rate


def warn(recipient: str, traffic: list[str], recommendation: dict[str, Any] | None) -> None:
    """Send an advisory; a crew acts on its recommendation."""
    advisory = {
        "id": "plain-1", "revision": 0, "recipient": recipient, "recipients": [*traffic, "ATC"],
        "kind": "loss_of_separation", "severity": "CAUTION", "traffic": traffic,
        "message": "two aircraft at the same level", "recommendation": recommendation,
        "t_ready_ns": warned[0], "evidence": {"sources": ["adsb"]},
    }  # fmt: skip
    session.put(f"{prefix}/advisory/{recipient}", json.dumps(advisory))


adsb = session.declare_subscriber(f"{prefix}/adsb/*", receive)
clock = session.declare_subscriber(f"{prefix}/clock")
token = session.liveliness().declare_token(f"{prefix}/worker/plain")
for sample in clock:
    if json.loads(sample.payload.to_bytes())["phase"] in ("finished", "stopped"):
        break
session.close()  # type: ignore[no-untyped-call]  # without it the process hangs at its exit
