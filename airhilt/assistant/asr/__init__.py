"""Speech recognition: audio from the radio in, transcripts out."""
