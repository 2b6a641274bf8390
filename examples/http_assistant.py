"""An assistant behind an address in some fifty lines, with nothing but Python's own library.

    python examples/http_assistant.py 9000
    airhilt cosim --scenario s02a_headon --assistant http://127.0.0.1:9000/advise

It answers each request with all conflicts that hold now. One begins when two aircraft are within
22 NM (about 40 km) and 1,000 ft of each other: one crew is told to climb, the other to descend. It
lasts, with the same levels, until the two are further than that apart: crews return to their levels
when a conflict is not listed any more.
"""

import json
import math
import sys
from http.server import BaseHTTPRequestHandler, HTTPServer
from itertools import combinations
from typing import Any

Json = dict[str, Any]
NEAR_NM = 22.0
open_conflicts: dict[str, Json] = {}


def advisories(request: Json) -> list[Json]:
    before = open_conflicts.copy()
    open_conflicts.clear()
    flying = [track for track in request["tracks"] if track["altitude_ft"] is not None]
    for pair in combinations(flying, 2):
        lower, upper = sorted(pair, key=lambda track: (track["altitude_ft"], track["icao24"]))
        name = "-".join(sorted(track["icao24"] for track in pair))
        are_level = upper["altitude_ft"] - lower["altitude_ft"] < 1000
        if distance_nm(lower, upper) < NEAR_NM and (name in before or are_level):
            open_conflicts[name] = before.get(name) or conflict(name, lower, upper)
    return list(open_conflicts.values())


def distance_nm(one: Json, other: Json) -> float:
    """Return a distance: a minute of latitude is a nautical mile, of longitude at the equator."""
    north_deg = other["latitude_deg"] - one["latitude_deg"]
    east_deg = (other["longitude_deg"] - one["longitude_deg"] + 180) % 360 - 180
    middle_deg = (one["latitude_deg"] + other["latitude_deg"]) / 2
    return 60 * math.hypot(north_deg, east_deg * math.cos(math.radians(middle_deg)))


def conflict(name: str, lower: Json, upper: Json) -> Json:
    low, high = (track["callsign"] or track["icao24"] for track in (lower, upper))
    return {
        "id": name,
        "kind": "loss_of_separation",
        "severity": "CAUTION",
        "recipients": [low, high, "ATC"],
        "traffic": [low, high],
        "recommendations": {
            low: level("descend", lower["altitude_ft"] - 1000),
            high: level("climb", upper["altitude_ft"] + 1000),
        },
        "evidence": {"sources": ["adsb"], "note": "traffic at the same level"},
    }


def level(sense: str, altitude_ft: float) -> Json:
    return {
        "action": "altitude",
        "sense": sense,
        "altitude_ft": altitude_ft,
        "vertical_rate_fpm": 1500,
    }


class Handler(BaseHTTPRequestHandler):
    def do_POST(self) -> None:
        request = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        answer = json.dumps({"advisories": advisories(request)}).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(answer)))
        self.end_headers()
        self.wfile.write(answer)

    def log_message(self, *_: object) -> None:
        """Print nothing about a request."""


if __name__ == "__main__":
    HTTPServer(("127.0.0.1", int(sys.argv[1])), Handler).serve_forever()
