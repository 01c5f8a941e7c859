"""The door for browsers and REST clients."""
