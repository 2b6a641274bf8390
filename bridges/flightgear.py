"""Shows one aircraft of a run in FlightGear, which then needs no flight dynamics of its own.

    fgfs --fdm=external --native-fdm=socket,in,30,,5500,udp
    python bridges/flightgear.py --connect tcp/127.0.0.1:7447 --aircraft AAL123

Place and attitude are the true ones, so the run has to share its truth (``--share-truth``). Gear
and flaps are those of the cockpit instruments; without them the gear is down on the ground. Engines
and fuel stay as FlightGear has them. The bridge ends with the run.

The packet is `FGNetFDM` of FlightGear 2020.3, src/Network/net_fdm.hxx, version 24.
"""

from __future__ import annotations

import struct

from airhilt.bus.bridge import datagrams, exiting_on_error, options, relay
from airhilt.messages import ActorTruth, CockpitInstruments
from airhilt.units import DEGREE, FOOT, KNOT, STANDARD_GRAVITY

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


class Aircraft:
    """Makes the packets of one aircraft of a run.

    Parameters
    ----------
    callsign
        Its callsign.
    """

    def __init__(self, callsign: str) -> None:
        self._callsign = callsign
        self._instruments: CockpitInstruments | None = None
        self._is_shown = False

    def read(self, instruments: CockpitInstruments) -> None:
        """Take gear and flaps, if the instruments are those of the aircraft."""
        if instruments.callsign == self._callsign:
            self._instruments = instruments

    def missing(self) -> str | None:
        """Return a line on the aircraft if no state of it has come."""
        if self._is_shown:
            return None
        return (
            f"no report of {self._callsign} yet; expected the callsign of an aircraft of a run "
            "with --share-truth"
        )

    def packet(self, state: ActorTruth) -> bytes | None:
        """Return the packet of a state; None if it is that of another actor."""
        if state.actor != self._callsign:
            return None
        self._is_shown = True
        if self._instruments is None:
            return packet(state, gear=float(state.on_ground), flaps=0.0)
        return packet(state, self._instruments.gear, self._instruments.flaps)


def main() -> None:
    """Run the bridge until the run is over."""
    parser = options(__doc__, 5500)
    parser.add_argument("--to", default="127.0.0.1", metavar="HOST", help="default: 127.0.0.1")
    parser.add_argument("--aircraft", required=True, metavar="CALLSIGN", help="what to show")
    given = parser.parse_args()
    aircraft = Aircraft(given.aircraft)
    with exiting_on_error():
        send = datagrams(given.to, given.port)

        def show(data: bytes) -> None:
            if (made := aircraft.packet(ActorTruth.model_validate_json(data))) is not None:
                send(made)

        relay(
            given,
            {
                "truth/state/*": show,
                "cockpit/*": lambda data: aircraft.read(
                    CockpitInstruments.model_validate_json(data)
                ),
            },
            missing=aircraft.missing,
        )


if __name__ == "__main__":
    main()
