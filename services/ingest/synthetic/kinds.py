"""Kinds of gait that a synthetic walker may have."""

KINDS = ("plain", "healthy", "hemiparetic", "stiff_knee", "steppage")
"""Words of the dial `patient`; plain is the walker whose joints follow curves."""
PLAIN, HEALTHY, HEMIPARETIC, STIFF_KNEE, STEPPAGE = range(len(KINDS))
