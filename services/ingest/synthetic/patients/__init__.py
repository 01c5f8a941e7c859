"""Walkers whose footfalls are planned first, so that each step's truth is known: healthy people and patients."""
