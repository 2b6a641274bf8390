"""The machine that AIRHILT runs on: files, caches, processes, HTTP, ONNX Runtime, library data."""
