"""All arrays of one filter behind one reference: to hand sixty arrays to a kernel costs as much as a step."""

from typing import Any

from numba import types
from numba.experimental import structref

from services.biomech.kernels.compiled import kernel
from services.biomech.kernels.step import step
from services.biomech.kernels.tables import (
    Array,
    Body,
    Columns,
    Companions,
    Flags,
    Motion,
    Noise,
    Options,
    Sensors,
    Update,
)

FIELDS = ["x", "P", "bias", "body", "sensors", "columns", "options", "noise", "motion", "update", "companions"]


@structref.register
class _BundleType(types.StructRef):  # type: ignore[misc]
    """The compiler's view of a bundle."""


class Bundle(structref.StructRefProxy):  # type: ignore[misc]
    """What `step` works on, except the samples. The arrays are shared, not copied."""


structref.define_proxy(Bundle, _BundleType, FIELDS)


@kernel
def tie(
    x: Array, P: Array, bias: Array,
    body: Body, sensors: Sensors, columns: Columns, options: Options, noise: Noise, motion: Motion, update: Update,
    companions: Companions,
) -> Any:  # fmt: skip
    """The bundle of these arrays."""
    return Bundle(x, P, bias, body, sensors, columns, options, noise, motion, update, companions)


@kernel
def advance(bundle: Any, dt: float, jerk: Array, samples: Array, fresh: Flags, rest: Array) -> None:
    """`step` on the arrays of a bundle."""
    step(
        bundle.x, bundle.P, dt, jerk, samples, fresh, bundle.bias, rest,
        bundle.body, bundle.sensors, bundle.columns, bundle.options, bundle.noise, bundle.motion, bundle.update,
        bundle.companions,
    )  # fmt: skip
