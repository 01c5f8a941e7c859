"""Inertial sensors and a depth camera in one estimate."""
