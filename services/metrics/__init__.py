"""Strides become the numbers of a session."""
