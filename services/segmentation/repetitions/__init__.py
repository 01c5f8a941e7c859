"""Repetitions of an exercise of the knee."""
