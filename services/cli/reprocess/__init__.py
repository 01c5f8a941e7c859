"""`ambula reprocess`: archived sessions computed anew, beside what was computed then."""
