"""Scoreboards: each prints a table of measured figures beside their targets."""
