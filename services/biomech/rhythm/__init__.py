"""The rhythm of a walk: phase, stride frequency, waveform and the jerk that follows from them."""
