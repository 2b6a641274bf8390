"""Random encounters of two aircraft for assistants that watch the air."""
