"""The Rhythmic EKF against the plain one."""
