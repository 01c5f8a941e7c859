"""Pure mathematics of the body: rotations, models, Kalman steps, rhythm."""
