"""One revolute joint with one IMU: the simulation of the Rhythmic EKF, small enough to see what each part buys."""
