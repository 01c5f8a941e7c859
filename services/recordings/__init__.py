"""Recorded sessions, read only: from bytes on a disk to messages in time order."""
