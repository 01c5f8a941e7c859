"""Erasing for good: rows, recordings, names, and what is on its way; a list of it outlives every restored backup."""
