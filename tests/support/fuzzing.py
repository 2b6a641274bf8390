"""Settings of the tests that try any input."""

from __future__ import annotations

from hypothesis import HealthCheck, settings

any_input = settings(suppress_health_check=[HealthCheck.too_slow])
"""As many examples as the profile of Hypothesis has, at any speed."""
