"""Ambula's processes and the libraries they share; see services/README.md."""
