"""Tasks of the whole body and gait from a camera, against truth."""
