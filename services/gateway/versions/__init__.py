"""Results of a session by the software that computed them."""
