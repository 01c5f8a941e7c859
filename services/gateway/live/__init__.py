"""What happens now, pushed to browsers."""
