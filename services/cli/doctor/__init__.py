"""`ambula doctor`: is everything here that Ambula needs, and if not, what to do."""
