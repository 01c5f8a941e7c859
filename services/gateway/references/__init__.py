"""Reference sets that this site has."""
