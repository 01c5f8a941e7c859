"""What each number of a session is: name, unit, one sentence."""
