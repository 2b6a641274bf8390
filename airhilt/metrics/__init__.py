"""What came of a run: truth about conflicts, latencies, the summary and the report."""
