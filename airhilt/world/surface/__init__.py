"""The airport: runways, taxiways, and what moves on them by itself."""
