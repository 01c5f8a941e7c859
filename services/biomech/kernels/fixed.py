"""Row lengths the compiler knows. It then proves that rows do not overlap, and runs over whole vector registers."""

from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core.imputils import impl_ret_borrowed
from numba.extending import intrinsic
from numba.np.arrayobj import make_array

LANES = 8
"""Row lengths are multiples of so many doubles: half of the widest register wastes least."""

Width = tuple[int, ...]
"""Stands for rows of LANES times its length; the numbers in it mean nothing."""


def width_of(columns: int) -> Width:
    """The shortest rows that hold so many columns."""
    return (0,) * -(-columns // LANES)


@intrinsic  # type: ignore[untyped-decorator]
def fixed(_typing_context: Any, rows: Any, width: Any) -> Any:
    """The same C-contiguous (?, M) float64 array with M as a constant of the machine code. M must be right."""
    length = LANES * len(width)

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = make_array(signature.return_type)(context, builder, value=arguments[0])
        size = context.get_value_type(types.intp)
        doubles = builder.extract_value(array.shape, 0)
        array.shape = builder.insert_value(array.shape, ir.Constant(size, length), 1)
        array.strides = builder.insert_value(array.strides, ir.Constant(size, 8 * length), 0)
        array.strides = builder.insert_value(array.strides, ir.Constant(size, 8), 1)
        array.nitems = builder.mul(doubles, ir.Constant(size, length))
        return impl_ret_borrowed(context, builder, signature.return_type, array._getvalue())

    return rows(rows, width), code
