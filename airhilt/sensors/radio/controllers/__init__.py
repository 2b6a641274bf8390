"""Simulated controllers: they read advisories, look at their displays, and speak on the radio.

`Controllers` is the way in. `Judgement` decides on measures from `Strips` and `Displays`, and
`Wording` puts them into words. Crews and drivers act because they hear those words.
"""

from airhilt.sensors.radio.controllers.controllers import Controllers

__all__ = ["Controllers"]
