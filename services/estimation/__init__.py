"""Sample streams become joint states."""
