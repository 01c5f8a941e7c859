"""Compiled inner loops of the lower-body filter: kinematics, measurement rows, covariance, one step."""
