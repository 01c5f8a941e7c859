"""Compiled mathematics of the whole body."""
