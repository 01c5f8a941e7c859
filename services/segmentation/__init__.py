"""Joint states become gait events and strides."""
