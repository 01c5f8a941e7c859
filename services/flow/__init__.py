"""Pure plumbing: messages, nodes, order, replay rings, checkpoints. No socket, clock or file."""
