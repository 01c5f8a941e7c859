"""Joint angles of the whole estimate against optical motion capture."""
