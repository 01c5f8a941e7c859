"""How the knee is compiled."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

from services.biomech.kernels.compiled import sources_fingerprint

Function = TypeVar("Function", bound=Callable[..., Any])

_FASTMATH = {"arcp", "nsz", "reassoc"}
"""Without "contract": which products are fused with sums then depends on whether the code was just compiled or comes
from the disk, and a session that is resumed after a first start would differ in the last bit."""

_STAMP = sources_fingerprint(Path(__file__).parent)


def compiled(function: Function) -> Function:
    """Compile on first use and keep the machine code on disk until any file of this folder changes.

    Not a number stays not a number: that is how unusable samples are told. Of fastmath only what keeps that.
    """
    dispatcher = numba.njit(cache=True, error_model="numpy", nogil=True, fastmath=_FASTMATH)(function)
    dispatcher._cache._cache_file._source_stamp = _STAMP
    return dispatcher  # type: ignore[no-any-return]
