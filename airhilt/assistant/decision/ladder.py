"""The last rung of the AIRHILT paper's ladder: several weak hints together (arXiv 2511.18718)."""

from __future__ import annotations

from airhilt.messages import Severity

VISION, ACTIVITY, COMMUNICATION = 0.50, 0.35, 0.15
CAUTION_FROM, ADVISORY_FROM = 0.75, 0.50


def fused_severity(vision: float, activity: float, communication: float) -> Severity | None:
    """Return the severity of several weak hints together; None if they do not suffice.

    Parameters
    ----------
    vision
        Belief that a runway is occupied, by cameras, from 0 to 1.
    activity
        Degree to which the runway is in use, from 0 to 1.
    communication
        Degree to which what was said agrees with that, from 0 to 1.
    """
    score = VISION * vision + ACTIVITY * activity + COMMUNICATION * communication
    if score >= CAUTION_FROM:
        return Severity.CAUTION
    return Severity.ADVISORY if score >= ADVISORY_FROM else None
