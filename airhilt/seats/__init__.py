"""The seats of a run: who has each, what they agree to, hear and are asked, and what they may do.

`Seats` is the only place that knows. Everybody else acts by a `SeatAction` and reads a `SeatState`.
"""

from airhilt.seats.seats import Seats

__all__ = ["Seats"]
