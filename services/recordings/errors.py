"""What can go wrong with a recording, as types a caller can act on."""

from enum import StrEnum
from pathlib import Path


class ArchiveError(Exception):
    """Base of everything that reading or writing recorded sessions raises on purpose."""


class NotARecording(ArchiveError):
    """The folder or file holds no session of ours."""


class DamageKind(StrEnum):
    """Why a file ends early."""

    TRUNCATED = "truncated"
    CORRUPT = "corrupt"


class Damage(ArchiveError):
    """The bytes from `offset` on cannot be trusted; what came before is right."""

    def __init__(self, kind: DamageKind, offset: int, reason: str) -> None:
        super().__init__(f"{kind} at byte {offset}: {reason}")
        self.kind = kind
        self.offset = offset
        self.reason = reason


class DamagedRecording(ArchiveError):
    """Raised after everything readable was handed out: the recording had more, or has been altered."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path.name}: {reason}. What was read before is right; restore this file from a backup.")
        self.path = path
        self.reason = reason
