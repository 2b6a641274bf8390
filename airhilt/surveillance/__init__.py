"""Where aircraft are and will be: ADS-B, closest point of approach, TCAS II thresholds."""
