"""The lower body from up to five sensors and feet: calibration, filter with rhythm, what silent sensors would say."""
