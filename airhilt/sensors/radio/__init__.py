"""The radio: what is said on a frequency, and what it means."""
