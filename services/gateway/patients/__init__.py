"""Patients under random codes."""
