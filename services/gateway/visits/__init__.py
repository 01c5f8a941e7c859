"""What a patient did at each coming."""
