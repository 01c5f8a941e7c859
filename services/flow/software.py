"""Which software this is."""

from importlib.metadata import version

SOFTWARE = f"ambula {version('ambula')}"
"""Name and version, as results carry them."""
