"""The last rung of the AIRHILT paper's ladder: several weak hints together (arXiv 2511.18718)."""

from __future__ import annotations

from airhilt.messages import Severity

VISION, ACTIVITY, COMMUNICATION = 0.50, 0.35, 0.15
CAUTION_FROM, ADVISORY_FROM = 0.75, 0.50


def fused_severity(vision: float, activity: float, communication: float) -> Severity | None:
    """Return how severe hints are that none alone is enough for; None if not even together.

    Parameters
    ----------
    vision
        How sure cameras are that a runway is occupied, 0 to 1.
    activity
        Whether somebody uses it, 0 to 1.
    communication
        Whether what was said agrees with that, 0 to 1.
    """
    score = VISION * vision + ACTIVITY * activity + COMMUNICATION * communication
    if score >= CAUTION_FROM:
        return Severity.CAUTION
    return Severity.ADVISORY if score >= ADVISORY_FROM else None
