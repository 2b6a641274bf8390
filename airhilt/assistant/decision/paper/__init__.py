"""The decision ladder of the AIRHILT paper (arXiv 2511.18718): thresholds, rungs, engine parts."""
