"""Message catalogues: one TOML file per language with the same keys and placeholders, and how to read them."""
