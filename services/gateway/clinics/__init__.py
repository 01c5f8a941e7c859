"""The clinics of a site, and how long each keeps its recordings."""
