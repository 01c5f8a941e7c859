"""Reports of sessions, as content, page and PDF."""
