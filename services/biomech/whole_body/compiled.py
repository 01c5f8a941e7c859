"""How the whole body's kernels are compiled."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

from services.biomech.kernels.compiled import sources_fingerprint

Function = TypeVar("Function", bound=Callable[..., Any])

_STAMP = sources_fingerprint(Path(__file__).parent / "kernels")

_FASTMATH = {"nnan", "ninf", "nsz", "arcp", "reassoc", "afn"}
"""All of it but "contract": see services/biomech/two_sensor_knee/compiled.py."""


def compiled(function: Function) -> Function:
    """Compile on first use and keep the machine code on disk until a file of `kernels` changes.

    fastmath presumes finite numbers: centres that are not finite must not reach a kernel.
    """
    dispatcher = numba.njit(cache=True, error_model="numpy", nogil=True, fastmath=_FASTMATH)(function)
    dispatcher._cache._cache_file._source_stamp = _STAMP
    return dispatcher  # type: ignore[no-any-return]
