"""A session that is over, moment by moment, out of its recording."""
