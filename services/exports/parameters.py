"""Every tunable of the exports."""

MOSTLY = 0.9
"""Share of samples in which an angle must be valid to be written where a column cannot have holes (our choice)."""
LONGEST_STEP = 3.0
"""Periods between two samples over which a value is interpolated; longer ones are a gap."""
MOST_SAMPLES = 720_000
"""Samples whose angles are held at a time: two hours at 100 Hz."""
SKELETON_HZ = 30.0
"""Skeletons a second in a recording for Foxglove; angles come at their own rate."""
ROWS_AT_A_TIME = 4096
"""Frames or rows that are encoded together."""
