"""How the services are."""
