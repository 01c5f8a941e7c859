"""Phases of walks for time and of measured walks, out of contacts, strides and the heading."""
