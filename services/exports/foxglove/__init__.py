"""A recording that Foxglove shows as it is: the skeleton in 3D, angles to plot, contacts as a log."""
