"""Sensors: radio, cameras and surveillance, which show the world to the assistant."""
