"""Did this patient really change: visits, baseline, thresholds and verdicts."""
