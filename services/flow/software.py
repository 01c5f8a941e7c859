"""Which software this is: its version, and a digest of the sources that decide what numbers come out.

Two results with the same string were computed by the same code. Screens, file formats, exports and the command line
are not part of it: changing them changes no number.
"""

import hashlib
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

DECISIVE = (
    "schemas",
    "services/biomech",
    "services/definitions",
    "services/estimation",
    "services/flow",
    "services/metrics",
    "services/segmentation",
)
"""Folders whose sources decide numbers, from the folder in which the packages lie."""


def digest_of_sources(root: Path, folders: Sequence[str] = DECISIVE) -> str:
    """8 hexadecimal digits over path and bytes of every .py file below the folders, the paths in sorted order.

    The same for a clone and for an installed wheel, wherever they lie.
    """
    digest = hashlib.sha256()
    found = {path.relative_to(root).as_posix(): path for folder in folders for path in (root / folder).rglob("*.py")}
    for name, path in sorted(found.items()):
        data = path.read_bytes()
        digest.update(f"{name}\0{len(data)}\0".encode() + data)
    return digest.hexdigest()[:8]


VERSION = f"{version('ambula')}+{digest_of_sources(Path(__file__).parents[2])}"
"""As in the names of derived files: 0.1.0+1f2e3d4c."""

SOFTWARE = f"ambula {VERSION}"
"""Name and version, as results carry them."""
