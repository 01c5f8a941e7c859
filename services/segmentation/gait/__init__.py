"""Contacts and strides: of a whole leg, of a lone shank or foot, of the lower back."""
