"""Walks for time and measured walks against what was truly walked."""
