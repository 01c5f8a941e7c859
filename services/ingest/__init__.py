"""Sensors, recordings and simulations become SI sample streams here."""
