"""Repetitions of knee exercises against what was truly done."""
