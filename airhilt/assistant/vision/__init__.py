"""The worker that looks: pictures in, detections out."""
