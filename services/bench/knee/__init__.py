"""The two-sensor knee against optical truth, published methods and synthetic legs."""
