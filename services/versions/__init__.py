"""What two versions of the software make of the same session."""
