"""From angles to a verdict: metrics, progress, report and exports against what is known."""
