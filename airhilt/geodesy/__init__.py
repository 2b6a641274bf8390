"""Geometry on the WGS84 ellipsoid: local frames, positions, relative motion."""
