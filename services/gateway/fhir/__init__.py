"""Sessions for hospital information systems."""
