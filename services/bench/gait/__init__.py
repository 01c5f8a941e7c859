"""Gait events and strides against contacts that somebody or something else has seen."""
