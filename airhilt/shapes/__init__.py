"""The shapes of what moves: aircraft, vehicles, animals."""
