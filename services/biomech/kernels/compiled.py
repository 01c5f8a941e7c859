"""How kernels are compiled, and when a compiled kernel on disk is out of date."""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., Any])

OPTIONS = {"cache": True, "fastmath": True, "boundscheck": False, "error_model": "numpy", "nogil": True}
"""fastmath lets the compiler vectorise sums. It presumes finite numbers: callers check samples before."""


def sources_fingerprint(folder: Path) -> tuple[float, int]:
    """A stamp that changes when any kernel source in the folder changes."""
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in sorted(folder.glob("*.py")))).digest()
    return float(int.from_bytes(digest[:6], "big")), int.from_bytes(digest[6:12], "big")


_STAMP = sources_fingerprint(Path(__file__).parent)


def kernel(function: Function) -> Function:
    """Compile on first use and keep the machine code on disk.

    Numba looks only at the file of the function itself when it decides whether the code on disk still holds, not
    at the functions that were compiled into it. A change in one kernel file would leave its callers stale, so the
    stamp is taken over all of them.

    Kernels that call it take it in: a call would copy the tables' sixty array headers.
    """
    return _compiled(function, OPTIONS)


def strict_kernel(function: Function) -> Function:
    """The same for numbers that may not be finite: fastmath would take every number for finite."""
    return _compiled(function, OPTIONS | {"fastmath": False})


def _compiled(function: Function, options: dict[str, Any]) -> Function:
    dispatcher = numba.njit(forceinline=True, **options)(function)
    cache_file = dispatcher._cache._cache_file
    if not hasattr(cache_file, "_source_stamp"):
        raise RuntimeError("this numba keeps its cache stamp elsewhere: adapt services/biomech/kernels/compiled.py")
    cache_file._source_stamp = _STAMP
    return dispatcher  # type: ignore[no-any-return]


def inlined(function: Function) -> Function:
    """A small function compiled into each kernel that calls it."""
    options = {key: value for key, value in OPTIONS.items() if key not in ("cache", "nogil")}
    return numba.njit(inline="always", **options)(function)  # type: ignore[no-any-return]
