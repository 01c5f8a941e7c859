"""Every message of a session, safe on disk."""
