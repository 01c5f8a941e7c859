"""Keys of machines, as their administrators see them."""
