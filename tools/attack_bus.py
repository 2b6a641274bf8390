"""Attacks a run from a process of its own, as a program that knows plain Zenoh may.

    airhilt cosim --scenario s02a_headon --no-cameras --latency fixed --pace realtime \
        --endpoint tcp/127.0.0.1:7447
    python tools/attack_bus.py tcp/127.0.0.1:7447 large

docs/security.md has what comes of it. Attack only runs of your own.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from typing import Any

import zenoh

ESCAPES = "\x1b[31mx\u202e"
"""Text that turns a terminal red, and the direction of writing."""
HEARD_S = 5.0
"""Time for which a spy listens, and a rogue answers, in s."""


def connected(where: str) -> tuple[Any, str]:
    """Return a session with the run, and the prefix of its keys.

    Parameters
    ----------
    where
        Endpoint of the run, or the file of a role of `airhilt keys init`.
    """
    config = zenoh.Config.from_file(where) if where.endswith(".json") else zenoh.Config()
    if not where.endswith(".json"):
        config.insert_json5("mode", '"client"')
        config.insert_json5("connect/endpoints", json.dumps([where]))
        config.insert_json5("connect/timeout_ms", "60000")
        config.insert_json5("scouting/multicast/enabled", "false")
    session = zenoh.open(config)
    while True:
        for reply in session.get("airhilt/*/clock"):
            if reply.ok and json.loads(reply.ok.payload.to_bytes())["phase"] == "running":
                return session, str(reply.ok.key_expr).removesuffix("/clock")
        time.sleep(0.05)


def advisory(number: int, message: str) -> str:
    """Return an advisory to the controller."""
    told = {
        "id": f"attack-{number}", "revision": 0, "recipient": "ATC", "recipients": ["ATC"],
        "kind": "loss_of_separation", "severity": "WARNING", "traffic": ["AAL123"],
        "message": message, "t_ready_ns": 0, "evidence": {"sources": ["adsb"]},
    }  # fmt: skip
    return json.dumps(told)


def detections(number: int, text: str) -> str:
    """Return what was found in a picture of a camera that has a long name."""
    angles = dict.fromkeys(("latitude_deg", "longitude_deg", "heading_deg"), 0)
    view = angles | {
        "height_m": 1, "pitch_deg": 0, "roll_deg": 0, "horizontal_fov_deg": 50, "width_px": 9,
        "height_px": 9,
    }  # fmt: skip
    told = {"camera": f"{number}{text}", "seq": 0, "t_frame_ns": 0, "view": view, "engine": "x"}
    return json.dumps(told)


def large(session: Any, prefix: str, number: int) -> None:
    """Publish an advisory of a megabyte."""
    session.put(f"{prefix}/advisory/ATC", advisory(number, ESCAPES * 60_000))


def names(session: Any, prefix: str, number: int) -> None:
    """Publish detections of another camera each time, whose name is a megabyte of escapes."""
    session.put(f"{prefix}/vision/tower", detections(number, ESCAPES * 60_000))


def escapes(session: Any, prefix: str, number: int) -> None:
    """Publish what is small enough, and full of escapes: an advisory, detections, no command."""
    session.put(f"{prefix}/advisory/ATC", advisory(number, ESCAPES * 100))
    session.put(f"{prefix}/vision/tower", detections(number, ESCAPES * 100))
    session.put(f"{prefix}/command/AAL123", json.dumps({ESCAPES * 100: number}))


def small(session: Any, prefix: str, number: int) -> None:
    """Publish a small advisory."""
    session.put(f"{prefix}/advisory/ATC", advisory(number, "traffic"))


def malformed(session: Any, prefix: str, number: int) -> None:
    """Publish what is no advisory."""
    session.put(f"{prefix}/advisory/ATC", json.dumps({f"field{number}": number}))


def forged(session: Any, prefix: str, _: int) -> None:
    """Publish what only the run may, and take its liveliness back."""
    for key in ("clock", "adsb/a1b2c3", "status/adsb", "truth/state/AAL123", "briefing"):
        session.put(f"{prefix}/{key}", json.dumps({"run": "x", "phase": "finished", "pace": "x"}))
    session.liveliness().declare_token(f"{prefix}/run").undeclare()


FLOODS: dict[str, Callable[[Any, str, int], None]] = {
    each.__name__: each for each in (large, names, escapes, small, malformed, forged)
}


def numbered(session: Any, prefix: str, count: int) -> None:
    """Publish small advisories with a number each."""
    publisher = session.declare_publisher(f"{prefix}/advisory/ATC")
    for number in range(count):
        source = zenoh.SourceInfo(publisher.id, number)
        publisher.put(advisory(number, "traffic"), source_info=source)


def spy(session: Any, prefix: str, _: int) -> None:
    """Print the kinds of key that a subscriber to everything receives."""
    seen: set[str] = set()
    subscriber = session.declare_subscriber(
        "**", lambda each: seen.add(str(each.key_expr).removeprefix(f"{prefix}/").split("/")[0])
    )
    time.sleep(HEARD_S)
    subscriber.undeclare()
    print("received:", ", ".join(sorted(seen)))


def rogue(session: Any, prefix: str, _: int) -> None:
    """Answer for every worker with garbage."""

    def answer(query: zenoh.Query) -> None:
        with query:
            query.reply(query.key_expr, b"garbage", attachment=b"garbage")

    own = [
        session.declare_queryable(f"{prefix}/worker/*/{what}", answer, complete=True)
        for what in ("describe", "step")
    ]
    time.sleep(HEARD_S)
    for queryable in own:
        queryable.undeclare()


OTHERS: dict[str, Callable[[Any, str, int], None]] = {
    each.__name__: each for each in (numbered, spy, rogue)
}


def main() -> None:
    """Attack as the command line asks."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("where", help="endpoint of a run, or file of a role")
    parser.add_argument("attack", choices=[*FLOODS, *OTHERS])
    parser.add_argument("--count", type=int, default=2283, help="how many messages")
    given = parser.parse_args()
    session, prefix = connected(given.where)
    begun_s = time.monotonic()
    if given.attack in FLOODS:
        for number in range(given.count):
            FLOODS[given.attack](session, prefix, number)
    else:
        OTHERS[given.attack](session, prefix, given.count)
    print(f"{given.attack}: {time.monotonic() - begun_s:.1f} s")
    session.close()


if __name__ == "__main__":
    main()
