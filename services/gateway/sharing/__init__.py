"""Patients whom a named colleague of another clinic may see."""
