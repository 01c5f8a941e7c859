"""Tables as CSV whose first lines say what each column is."""
