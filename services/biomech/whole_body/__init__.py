"""Whole body from the joint centres of a depth camera: model, constrained Kalman filter, multibody fit, tuning."""
