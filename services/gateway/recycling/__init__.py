"""The bin: what was deleted, until its time is over or it is brought back."""
