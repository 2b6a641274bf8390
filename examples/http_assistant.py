"""An assistant behind an address in some forty lines, with nothing but Python's own library.

    python examples/http_assistant.py 9000
    airhilt cosim --scenario s02a_headon --assistant http://127.0.0.1:9000/advise

It answers each request with all conflicts that hold now: two aircraft within 1,000 ft and 0.45
degrees (about 40 km) of each other. One crew is told to climb, the other to descend.
"""

import json
import sys
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from itertools import combinations
from typing import Any

Json = dict[str, Any]


def advisories(request: Json) -> Iterator[Json]:
    flying = [track for track in request["tracks"] if track["altitude_ft"] is not None]
    for pair in combinations(flying, 2):
        lower, upper = sorted(pair, key=lambda track: (track["altitude_ft"], track["icao24"]))
        near_deg = sum(abs(lower[each] - upper[each]) for each in ("latitude_deg", "longitude_deg"))
        if near_deg >= 0.45 or upper["altitude_ft"] - lower["altitude_ft"] >= 1000:
            continue
        low, high = (track["callsign"] or track["icao24"] for track in (lower, upper))
        yield {
            "id": "-".join(sorted(track["icao24"] for track in pair)),
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
        answer = json.dumps({"advisories": list(advisories(request))}).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(answer)))
        self.end_headers()
        self.wfile.write(answer)

    def log_message(self, *_: object) -> None:
        """Print nothing about a request."""


if __name__ == "__main__":
    HTTPServer(("127.0.0.1", int(sys.argv[1])), Handler).serve_forever()
