"""The archive's files of a session, for download."""
