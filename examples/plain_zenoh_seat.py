"""A program that acts at a seat, in plain Zenoh. It imports nothing of AIRHILT.

    airhilt cosim --scenario s01b_nominal --no-cameras --seat tower --no-browser \
        --endpoint tcp/127.0.0.1:7447
    python examples/plain_zenoh_seat.py tcp/127.0.0.1:7447

Start it once the run has begun. The program takes the seat of the tower, says a call, prints what
is recognised and which tasks are due, and leaves the seat.
"""

import json
import secrets
import sys
import time
from typing import Any

import zenoh

config = zenoh.Config()
config.insert_json5("mode", '"client"')
config.insert_json5("connect/endpoints", json.dumps([sys.argv[1]]))
config.insert_json5("connect/timeout_ms", "60000")  # wait a minute for the run
config.insert_json5("scouting/multicast/enabled", "false")


def ask(key: str, **payload: Any) -> tuple[str, Any]:
    reply = next(iter(session.get(key, timeout=10.0, **payload))).ok
    return str(reply.key_expr), json.loads(reply.payload.to_bytes())


def act(do: str, **fields: Any) -> None:
    action = {"holder": holder, "secret": secret, "act": {"do": do, **fields}}
    print(do, ask(f"{seat}/do", payload=json.dumps(action))[1])


def show(call: zenoh.Sample) -> None:
    print(json.loads(call.payload.to_bytes())["text"])


with zenoh.open(config) as session:
    run = ask("airhilt/*/clock")[0].removesuffix("/clock")
    seat = f"{run}/seat/Washington_Tower"
    session.declare_subscriber(f"{run}/asr/*", show)
    holder, secret = secrets.token_hex(8), secrets.token_hex(16)
    token = session.liveliness().declare_token(f"{seat}/holder/{holder}")
    act("take")
    act("agree", uses=["words"])
    act("text", text="American one two three, continue approach")
    time.sleep(20.0)  # The crew answers.
    print("due:", [task["text"] for task in ask(seat)[1]["tasks"]])
    act("leave")
