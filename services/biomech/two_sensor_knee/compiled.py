"""How the knee is compiled."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

from services.biomech.kernels.compiled import sources_fingerprint

Function = TypeVar("Function", bound=Callable[..., Any])

_STAMP = sources_fingerprint(Path(__file__).parent)


def compiled(function: Function) -> Function:
    """Compile on first use and keep the machine code on disk until any file of this folder changes.

    No fastmath. Not a number stays not a number: that is how unusable samples are told. And nested functions whose sums
    may be reordered come out otherwise when they were just compiled than when they are loaded: a session resumed after
    a first start would differ in the last bit.
    """
    dispatcher = numba.njit(cache=True, error_model="numpy", nogil=True)(function)
    dispatcher._cache._cache_file._source_stamp = _STAMP
    return dispatcher  # type: ignore[no-any-return]
