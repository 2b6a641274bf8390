"""The scores of a run: warnings, separation, recognition, detection and latencies."""
