"""How the single joint is compiled."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

from services.biomech.kernels.compiled import sources_fingerprint

Function = TypeVar("Function", bound=Callable[..., Any])

_FOLDERS = [Path(__file__).parent.parent / name for name in ("single_joint", "rhythm", "kernels")]
"""Rhythm and evidence are compiled into the loops here, so their sources decide as well whether code on disk holds."""
_STAMPS = [sources_fingerprint(folder) for folder in _FOLDERS]
_STAMP = (sum(stamp[0] for stamp in _STAMPS), sum(stamp[1] for stamp in _STAMPS))


def compiled(function: Function) -> Function:
    """Compile on first use and keep the machine code on disk until a source it was made of changes.

    Not a number stays not a number (no fastmath): that is how unusable samples are told.
    """
    dispatcher = numba.njit(cache=True, error_model="numpy", nogil=True)(function)
    dispatcher._cache._cache_file._source_stamp = _STAMP
    return dispatcher  # type: ignore[no-any-return]
