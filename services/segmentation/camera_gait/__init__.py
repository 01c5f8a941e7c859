"""Gait events and steps out of the joint centres that a camera sees."""
