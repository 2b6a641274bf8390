"""Sensors: what workers perceive of the world. `airhilt.sensors.base` says what a sensor is."""
