"""Procedures: chains of phases, each of which flies one part and names the phase that follows."""
