"""What things cost: time of a step and of a frame, loss after a kill."""
