"""What can be played as a session."""
