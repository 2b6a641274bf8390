"""Decision: evidence from ADS-B, radio and cameras in, advisories out."""
