"""Every tunable of the archive."""

from dataclasses import dataclass

from services.recordings.limits import MIB

GIB = 1024 * MIB


@dataclass(frozen=True)
class ArchiveParameters:
    """Defaults hold for one clinic floor on one disk."""

    flush_interval_s: float = 0.1
    """s between two flush + fsync rounds; bounds the loss of a kill (measured: 0.10 s at most)."""
    rotation_s: float = 600.0
    """s after which a new file is begun; bounds what one bad disk block can cost."""
    chunk_bytes: int = MIB
    """bytes of messages in one chunk of a closed file, before compression."""
    queue_records: int = 20_000
    """messages that may wait for the disk: about 10 s of a full floor."""
    queue_alarm_share: float = 0.5
    """share of the queue above which the disk is reported as slow."""
    warn_free_bytes: int = 5 * GIB
    """bytes free on the disk below which a warning is given."""
    stop_free_bytes: int = GIB
    """bytes free below which nothing is recorded any more, so that the database can still write."""
    resume_free_bytes: int = GIB + GIB // 2
    """bytes free above which recording goes on after it was stopped."""
    disk_check_s: float = 2.0
    """s between two looks at the free space."""
    retry_s: float = 1.0
    """s after a failed write before the recording goes on in a new file."""
    progress_s: float = 0.1
    """s between two reports of the durable position."""
    progress_repeat_s: float = 1.0
    """s after which the durable position is reported again although it has not changed."""
    claim_s: float = 5.0
    """s after the start within which a session that still runs has come back; other open recordings are closed."""
    gone_s: float = 30.0
    """s without a session's token after which its recording is closed as interrupted."""
    checkpoint_bytes: int = 16 * MIB
    """bytes above which a checkpoint is refused."""
    checkpoints_in_memory: int = 600
    """newest checkpoints kept in memory: three nodes of 200 sessions."""


PARAMETERS = ArchiveParameters()
