"""Whole bodies before a depth camera: people, what they do, where their joint centres are, what the camera says."""
