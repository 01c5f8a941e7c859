"""A disk that fails on command."""

import errno

import pytest

from services.archive.disk import Disk


class FailingDisk(Disk):
    """Raises OSError at the n-th call that changes the disk (and at all later ones, if `forever`)."""

    CHANGING = ("create", "write", "sync", "replace", "remove", "sync_folder")

    def __init__(self, fail_at, number=errno.EIO, forever=False):
        self.fail_at = fail_at
        self.calls = 0
        self.number = number
        self.forever = forever

    @property
    def failed(self):
        return self.calls >= self.fail_at

    def _count(self):
        self.calls += 1
        if self.calls == self.fail_at or (self.forever and self.calls > self.fail_at):
            raise OSError(self.number, "injected")

    def write(self, descriptor, data):
        """Half of it gets through, as on a full disk."""
        try:
            self._count()
        except OSError:
            super().write(descriptor, data[: len(data) // 2])
            raise
        super().write(descriptor, data)


def _counted(name):
    def call(self, *arguments):
        self._count()
        return getattr(Disk, name)(self, *arguments)

    return call


for _name in FailingDisk.CHANGING:
    if _name != "write":
        setattr(FailingDisk, _name, _counted(_name))


@pytest.fixture
def failing_disk():
    """The class of disks that fail on command."""
    return FailingDisk
