"""The list of patients as somebody looks through it: when each came, and how they stand."""
