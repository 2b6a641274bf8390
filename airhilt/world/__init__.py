"""The true world of a run: flight, airport surface, actors, and what is true of them."""
