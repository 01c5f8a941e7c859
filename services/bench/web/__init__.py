"""The gateway under load, and the pages in a browser."""
