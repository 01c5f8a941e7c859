"""Single knees, each from a thigh and a shank sensor: ours and the published ones."""
