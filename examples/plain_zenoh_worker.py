"""A decision program in plain Zenoh. It imports nothing of AIRHILT and takes no time grants.

    airhilt cosim --scenario s02a_headon --endpoint tcp/127.0.0.1:7447 --attach plain
    python examples/plain_zenoh_worker.py tcp/127.0.0.1:7447

Start the two in either order. Because the program takes no grants, the run goes by the wall clock,
and an advisory counts when it arrives. The program warns the controller as soon as two aircraft are
at the same level.
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


def receive(sample: zenoh.Sample) -> None:
    report = json.loads(sample.payload.to_bytes())
    reports[report["icao24"]] = report
    levels = [report["altitude_ft"] for report in reports.values()]
    if len(levels) == 2 and abs(levels[0] - levels[1]) < 1000:
        warn(report["t_adsb_out_ns"])


def warn(t_ns: int) -> None:
    advisory = {
        "id": "plain-1", "revision": 0, "recipient": "ATC", "recipients": ["ATC"],
        "kind": "loss_of_separation", "severity": "CAUTION", "traffic": list(reports),
        "message": "two aircraft at the same level", "t_ready_ns": t_ns,
        "evidence": {"sources": ["adsb"]},
    }  # fmt: skip
    session.put(f"{prefix}/advisory/ATC", json.dumps(advisory))


adsb = session.declare_subscriber(f"{prefix}/adsb/*", receive)
clock = session.declare_subscriber(f"{prefix}/clock")
token = session.liveliness().declare_token(f"{prefix}/worker/plain")
for sample in clock:
    if json.loads(sample.payload.to_bytes())["phase"] in ("finished", "stopped"):
        break
session.close()  # type: ignore[no-untyped-call]  # without it the process hangs at its exit
