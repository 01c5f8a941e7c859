"""Pure fault injection: what sensors and radios do wrong, on purpose and seeded."""
