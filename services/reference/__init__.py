"""Reference sets: what other people's walks measured, with source, and a band only where one fits."""
