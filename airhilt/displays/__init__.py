"""Contents of a run for displays of other programs, live by a bridge or by `airhilt export`."""
