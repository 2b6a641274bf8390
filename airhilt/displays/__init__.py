"""What displays of other programs show of a run, live by a bridge or by `airhilt export`."""
