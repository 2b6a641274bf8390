"""A language model as the decider: what it is asked, and which of its answers the rules accept."""
