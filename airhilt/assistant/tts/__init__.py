"""Speech synthesis of the assistant: advisories in, its voice out."""
