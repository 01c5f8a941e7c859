"""What a session becomes outside Ambula: tables, C3D, OpenSim files, a recording for Foxglove. Bytes from messages."""
