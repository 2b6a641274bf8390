"""Pictures with their truth, exported to train and to judge detectors."""
