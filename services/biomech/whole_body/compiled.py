"""How the whole body's kernels are compiled."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

from services.biomech.kernels.compiled import sources_fingerprint

Function = TypeVar("Function", bound=Callable[..., Any])

_STAMP = sources_fingerprint(Path(__file__).parent / "kernels")


def compiled(function: Function) -> Function:
    """Compile on first use and keep the machine code on disk until a file of `kernels` changes.

    No fastmath: nested functions whose sums may be reordered come out otherwise when they were just compiled than when
    they are loaded, and a session resumed after a first start would differ in the last bit. So loops that must be fast
    run along rows, where nothing needs reordering.
    """
    dispatcher = numba.njit(cache=True, error_model="numpy", nogil=True)(function)
    file = dispatcher._cache._cache_file
    file._source_stamp = _STAMP
    file._load_index = _readable(file._load_index)
    return dispatcher  # type: ignore[no-any-return]


def _readable(load: Callable[[], dict[Any, str]]) -> Callable[[], dict[Any, str]]:
    """An index that names types which are no more is read before its stamp is looked at: it counts as stale, too."""

    def load_index() -> dict[Any, str]:
        try:
            return load()
        except (AttributeError, ImportError):
            return {}

    return load_index
