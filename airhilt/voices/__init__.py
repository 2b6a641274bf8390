"""Voices: text to speech for the speakers on the radio, and for the assistant."""
