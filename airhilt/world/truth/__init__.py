"""Ground truth: monitors of conflicts, runways and conditions that drive a run."""
