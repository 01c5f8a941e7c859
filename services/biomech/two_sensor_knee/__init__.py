"""One knee from two inertial sensors: the published band and self-finding axis, and ours beside each."""
