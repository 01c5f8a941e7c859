"""A synthetic walker that knows the truth about itself. Pure."""
