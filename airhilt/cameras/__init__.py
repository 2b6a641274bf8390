"""Cameras: what they see, drawn off-screen, and what is really there."""
