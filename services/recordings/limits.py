"""How much a reader takes from a file before it calls it damage."""

from dataclasses import dataclass

MIB = 1024 * 1024


@dataclass(frozen=True)
class ReadLimits:
    """Caps against damaged and hostile files (media type application/vnd.mcap, security considerations)."""

    record_bytes: int = 64 * MIB
    """largest record taken from a file; ours stay near 1 MiB."""
    chunk_bytes: int = 64 * MIB
    """largest chunk after decompression; ours stay near 1 MiB."""
    open_bytes: int = 256 * MIB
    """most decompressed data held at once while messages are put in time order."""


LIMITS = ReadLimits()
