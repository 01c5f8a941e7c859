"""Rhythm estimators on motions whose stride is known."""
