"""Surveillance systems as their standards define them: ADS-B, radar, TCAS II."""
