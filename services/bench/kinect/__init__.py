"""The whole body from a depth camera: simulated tasks, real recordings, methods side by side."""
