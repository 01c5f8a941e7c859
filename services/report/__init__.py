"""What a session means, on two pages: content from plain values, in words, tables and charts, and its PDF."""
