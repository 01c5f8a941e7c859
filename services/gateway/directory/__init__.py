"""The directory of names: who a patient code is, in a database and under a key of its own."""
