"""Recognition of speech: audio from the radio in, transcripts out."""
