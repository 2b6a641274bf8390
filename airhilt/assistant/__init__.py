"""The assistant under test: the reference workers."""
