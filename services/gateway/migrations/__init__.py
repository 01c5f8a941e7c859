"""Steps between versions of the database schema, applied at start."""
