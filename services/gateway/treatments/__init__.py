"""What was done for a patient, as marks beside the progress."""
