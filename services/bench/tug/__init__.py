"""Scoreboard of the timed up and go."""
