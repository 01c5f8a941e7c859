"""Signing in: local accounts, their passwords, and what a browser holds meanwhile."""
