"""Vision: pictures in, detections out."""
