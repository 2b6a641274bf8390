"""Shapes of aircraft, vehicles and animals: meshes, lights and outlines."""
