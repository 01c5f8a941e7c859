"""The phases of a timed up and go, out of joint angles or of the motion of the pelvis alone."""
