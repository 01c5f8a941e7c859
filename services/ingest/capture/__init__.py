"""Live skeletons from a capture PC: datagrams in, one followed person out."""
