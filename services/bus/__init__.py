"""The fabric: the only package that talks to Zenoh."""
