"""Angles that inertial sensors and a camera both tell, as one estimate that outlives the loss of either."""
