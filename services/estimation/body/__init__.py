"""The whole body of one person in front of a depth camera."""
