"""Audio samples and WAV files."""
