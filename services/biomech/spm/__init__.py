"""Statistical parametric mapping of curves: where in a movement two methods differ."""
