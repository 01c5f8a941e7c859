"""Baseline and progress of a patient."""
