"""The few things the archive asks of a disk, in one place so that tests can make each of them fail."""

import os
from pathlib import Path


class Disk:
    """Plain POSIX. Every method raises OSError as the system does."""

    def create(self, path: Path) -> int:
        """A new file for writing; FileExistsError rather than a lost recording."""
        return os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o640)

    def write(self, descriptor: int, data: bytes) -> None:
        """All of `data`, or OSError."""
        view = memoryview(data)
        while view:
            view = view[os.write(descriptor, view) :]

    def sync(self, descriptor: int) -> None:
        """Wait until the file's bytes are on the disk."""
        os.fsync(descriptor)

    def close(self, descriptor: int) -> None:
        """Give the descriptor back."""
        os.close(descriptor)

    def replace(self, source: Path, target: Path) -> None:
        """Rename atomically."""
        os.replace(source, target)

    def remove(self, path: Path) -> None:
        """Delete a file; it is no error when it is not there."""
        path.unlink(missing_ok=True)

    def sync_folder(self, folder: Path) -> None:
        """Make renames and new names in the folder survive a power cut."""
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)

    def free_bytes(self, folder: Path) -> int:
        """Bytes an ordinary user can still write."""
        facts = os.statvfs(folder)
        return facts.f_bavail * facts.f_frsize

    def replace_with(self, path: Path, data: bytes) -> None:
        """The file is afterwards the old one or the new one, never a mixture, also after a power cut."""
        draft = path.with_name(path.name + ".tmp")
        self.remove(draft)
        descriptor = self.create(draft)
        try:
            self.write(descriptor, data)
            self.sync(descriptor)
        finally:
            self.close(descriptor)
        self.replace(draft, path)
        self.sync_folder(path.parent)
