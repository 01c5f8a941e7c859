"""Numbers about the services themselves, for Prometheus. Never about who is treated or who looks on."""
