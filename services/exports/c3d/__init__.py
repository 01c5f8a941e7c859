"""C3D: joint centres, angles as model outputs, events and figures, as gait laboratories exchange them."""
