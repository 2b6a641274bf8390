"""Scenario JSON: what it may say, loading it, and its seeded perturbation."""

from airhilt.scenario.loading import check, load, parse
from airhilt.scenario.models import Scenario
from airhilt.scenario.perturbation import realise

__all__ = ["Scenario", "check", "load", "parse", "realise"]
