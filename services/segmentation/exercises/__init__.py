"""Repetitions of the tasks of the whole body."""
