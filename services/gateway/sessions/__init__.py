"""Sessions: started, stopped, watched and kept."""
