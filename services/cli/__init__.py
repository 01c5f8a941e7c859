"""The ambula command and the local supervisor."""
