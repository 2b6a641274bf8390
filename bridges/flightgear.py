r"""Shows an aircraft of a run in FlightGear, which then needs no flight dynamics, and the others.

    fgfs --fdm=external --native-fdm=socket,in,30,,5500,udp \
        --multiplay=in,30,127.0.0.1,5000 --multiplay=out,1,127.0.0.1,5001
    python bridges/flightgear.py --connect tcp/127.0.0.1:7447 --aircraft AAL123

Place and attitude are the true ones, so the run has to share its truth (``--share-truth``). Gear
and flaps are those of the cockpit instruments; without them the gear is down on the ground. Engines
and fuel stay as FlightGear has them. Between two states of the run, 0.2 s apart, the aircraft goes
on as it moved and turned. The other aircraft and vehicles are multiplayer traffic, which FlightGear
moves on by itself. The bridge ends with the run.

The packets are `FGNetFDM` of FlightGear 2020.3, src/Network/net_fdm.hxx, version 24, and
`T_MsgHdr` with `T_PositionMsg` of src/MultiPlayer/mpmessages.hxx, version 1.1.
"""

from __future__ import annotations

import math
import struct
import threading
import time
from collections.abc import Callable

from scipy.spatial.transform import Rotation

from airhilt.bus.bridge import datagrams, exiting_on_error, options, relay
from airhilt.geodesy.wgs84 import displaced, earth_centred
from airhilt.messages import ActorTruth, AdsbReport, CockpitInstruments
from airhilt.units import DEGREE, FOOT, KNOT, SECOND_NS, STANDARD_GRAVITY

RATE_HZ = 30.0
"""Packets of the chosen aircraft in a second."""
LONGEST_S = 0.5
"""Longest time for which the aircraft goes on without a new state; a pause holds it still then."""
STEADINESS = 0.1
"""Share of the error in its time that each new state mends, so that nothing jumps."""
PERIOD_S = 0.2
"""Time between two states of a run."""

VERSION = 24
WHEELS = 3
PACKET = struct.Struct(
    ">I4x"  # version
    "3d6f"  # longitude, latitude, altitude; height, roll, pitch, heading, angles of the flow
    "11f"  # turning rates, airspeed, climb rate, velocity over ground, velocity in the air
    "3f2f"  # accelerations, stall, slip
    "I4I36f"  # engines
    "I4f"  # tanks
    "I3I9f"  # wheels: weight on wheels, position, steering, compression
    "Iif"  # time, warp, visibility
    "10f"  # control surfaces, of which the third and fourth are the flaps
)

MULTIPLAYER = struct.Struct(
    ">4I2I8s"  # magic, version, kind, length; range and port, unused; callsign
    "96s2d3d"  # model; time, lag; Earth-centred place
    "15f4x"  # orientation, velocity, turning, and their changes
)
MAGIC, PROTOCOL, POSITION = 0x46474653, 0x00010001, 7
MODELS = {
    "A1": "Aircraft/c172/c-fgfs.xml",
    "A5": "Aircraft/747/744-Default.xml",
    "C1": "Models/Airport/Vehicle/fire-truck.xml",
    "C2": "Models/Airport/Vehicle/fire-truck.xml",
}
"""Models of FlightGear's base package by the emitter category of ADS-B."""
AIRLINER, TRUCK = "Aircraft/738/738-default.xml", MODELS["C2"]
"""Models of the other categories, and of vehicles without ADS-B."""


def packet(state: ActorTruth, gear: float, flaps: float) -> bytes:
    """Return the packet of a state; gear and flaps are from 0, up, to 1, down."""
    velocity_ft_s = (
        state.velocity_north_m_s / FOOT,
        state.velocity_east_m_s / FOOT,
        state.velocity_down_m_s / FOOT,
    )
    return PACKET.pack(
        VERSION,
        state.longitude_deg * DEGREE, state.latitude_deg * DEGREE, state.altitude_m,
        state.height_agl_m,
        state.roll_deg * DEGREE, state.pitch_deg * DEGREE, state.heading_deg * DEGREE, 0.0, 0.0,
        0.0, 0.0, 0.0, (state.calibrated_airspeed_m_s or 0.0) / KNOT, -velocity_ft_s[2],
        *velocity_ft_s, 0.0, 0.0, 0.0,
        0.0, 0.0, -STANDARD_GRAVITY / FOOT, 0.0, 0.0,
        0, *[0] * 4, *[0.0] * 36,
        0, *[0.0] * 4,
        WHEELS, *[int(state.on_ground)] * WHEELS, *[gear] * WHEELS, *[0.0] * 6,
        0, 0, 0.0,
        0.0, 0.0, flaps, flaps, *[0.0] * 6,
    )  # fmt: skip


def multiplayer(state: ActorTruth, model: str) -> bytes:
    """Return the packet of multiplayer traffic in a state; the callsign has 7 characters."""
    place = state.latitude_deg * DEGREE, state.longitude_deg * DEGREE
    horizon = Rotation.from_euler("ZY", [place[1], -math.pi / 2.0 - place[0]])
    attitude = Rotation.from_euler(
        "ZYX", [state.heading_deg, state.pitch_deg, state.roll_deg], degrees=True
    )
    velocity = state.velocity_north_m_s, state.velocity_east_m_s, state.velocity_down_m_s
    return MULTIPLAYER.pack(
        MAGIC, PROTOCOL, POSITION, MULTIPLAYER.size, 0, 0, state.actor[:7].encode(),
        model.encode(), state.t_ns / SECOND_NS, PERIOD_S, *earth_centred(place, state.altitude_m),
        *(horizon * attitude).as_rotvec(), *attitude.inv().apply(velocity), *[0.0] * 9,
    )  # fmt: skip


def ahead(state: ActorTruth, before: ActorTruth, time_s: float) -> ActorTruth:
    """Return a state some time on, if it moves and turns on as since the state before it."""
    place = displaced(
        (state.latitude_deg * DEGREE, state.longitude_deg * DEGREE),
        state.velocity_north_m_s * time_s, state.velocity_east_m_s * time_s, state.altitude_m,
    )  # fmt: skip
    since_s = (state.t_ns - before.t_ns) / SECOND_NS
    share = time_s / since_s if since_s > 0.0 else 0.0

    def turned(now_deg: float, before_deg: float) -> float:
        return now_deg + share * math.remainder(now_deg - before_deg, 360.0)

    down_m = state.velocity_down_m_s * time_s
    return state.model_copy(
        update={
            "latitude_deg": place[0] / DEGREE,
            "longitude_deg": place[1] / DEGREE,
            "altitude_m": state.altitude_m - down_m,
            "height_agl_m": state.height_agl_m - down_m,
            "roll_deg": turned(state.roll_deg, before.roll_deg),
            "pitch_deg": turned(state.pitch_deg, before.pitch_deg),
            "heading_deg": turned(state.heading_deg, before.heading_deg) % 360.0,
        }
    )


class Aircraft:
    """Makes the packets of one aircraft of a run.

    Times of the machine come from a clock that is monotonic, in s.

    Parameters
    ----------
    callsign
        Its callsign.
    """

    def __init__(self, callsign: str) -> None:
        self._callsign = callsign
        self._instruments: CockpitInstruments | None = None
        self._states: tuple[ActorTruth, ActorTruth] | None = None
        """The last state, and the one before it."""
        self._begin_s = 0.0
        """Time of the machine at which the run began, if it had always gone in real time."""

    def read(self, instruments: CockpitInstruments) -> None:
        """Take gear and flaps, if the instruments are those of the aircraft."""
        if instruments.callsign == self._callsign:
            self._instruments = instruments

    def missing(self) -> str | None:
        """Return a line on the aircraft if no state of it has come."""
        if self._states is not None:
            return None
        return (
            f"no report of {self._callsign} yet; expected the callsign of an aircraft of a run "
            "with --share-truth"
        )

    def hear(self, state: ActorTruth, now_s: float) -> None:
        """Take a state, if it is that of the aircraft."""
        if state.actor != self._callsign:
            return
        late_s = now_s - self._begin_s - state.t_ns / SECOND_NS
        is_new = self._states is None or abs(late_s) > LONGEST_S
        self._begin_s += late_s * (1.0 if is_new else STEADINESS)
        self._states = (state, state if self._states is None else self._states[0])

    def packet(self, now_s: float) -> bytes | None:
        """Return the packet of a time; None before the first state."""
        if self._states is None:
            return None
        last, before = self._states
        since_s = now_s - self._begin_s - last.t_ns / SECOND_NS
        state = ahead(last, before, min(max(since_s, 0.0), LONGEST_S))
        if self._instruments is None:
            return packet(state, gear=float(state.on_ground), flaps=0.0)
        return packet(state, self._instruments.gear, self._instruments.flaps)


class Others:
    """Makes the packets of all traffic but one aircraft.

    Parameters
    ----------
    callsign
        Callsign of that aircraft.
    """

    def __init__(self, callsign: str) -> None:
        self._callsign = callsign
        self._categories: dict[str, str] = {}
        """Emitter category by icao24."""

    def read(self, report: AdsbReport) -> None:
        """Take the category of a sender of ADS-B."""
        if report.emitter_category is not None:
            self._categories[report.icao24] = report.emitter_category

    def packet(self, state: ActorTruth) -> bytes | None:
        """Return the packet of a state; None if FlightGear has no model of what it is of."""
        if state.actor == self._callsign or state.category == "wildlife":
            return None
        usual = TRUCK if state.category == "vehicle" else AIRLINER
        category = self._categories.get(state.icao24 or "", "")
        return multiplayer(state, MODELS.get(category, usual))


def keep_sending(aircraft: Aircraft, send: Callable[[bytes], None]) -> None:
    """Send the packets of an aircraft, `RATE_HZ` in a second, for ever."""
    while True:
        if (made := aircraft.packet(time.monotonic())) is not None:
            send(made)
        time.sleep(1.0 / RATE_HZ)


def main() -> None:
    """Run the bridge until the run is over."""
    parser = options(__doc__, 5500)
    parser.add_argument("--to", default="127.0.0.1", metavar="HOST", help="default: 127.0.0.1")
    parser.add_argument("--aircraft", required=True, metavar="CALLSIGN", help="what to show")
    parser.add_argument(
        "--traffic-port",
        type=int,
        default=5000,
        metavar="N",
        help="port of --multiplay; default: 5000",
    )
    given = parser.parse_args()
    aircraft, others = Aircraft(given.aircraft), Others(given.aircraft)
    with exiting_on_error():
        send = datagrams(given.to, given.port)
        send_other = datagrams(given.to, given.traffic_port, "--to and --traffic-port")

        def show(data: bytes) -> None:
            state = ActorTruth.model_validate_json(data)
            aircraft.hear(state, time.monotonic())
            if (made := others.packet(state)) is not None:
                send_other(made)

        threading.Thread(target=keep_sending, args=(aircraft, send), daemon=True).start()
        relay(
            given,
            {
                "truth/state/*": show,
                "adsb/*": lambda data: others.read(AdsbReport.model_validate_json(data)),
                "cockpit/*": lambda data: aircraft.read(
                    CockpitInstruments.model_validate_json(data)
                ),
            },
            missing=aircraft.missing,
        )


if __name__ == "__main__":
    main()
