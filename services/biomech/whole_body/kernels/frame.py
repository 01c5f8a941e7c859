"""One frame of the filter: predict, recognise exchanged legs, fuse, keep within bounds."""

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.kinematics import place
from services.biomech.whole_body.kernels.prediction import predict
from services.biomech.whole_body.kernels.projection import project
from services.biomech.whole_body.kernels.swap import unswap
from services.biomech.whole_body.kernels.tables import (
    COORDINATES,
    SEEN,
    Array,
    Bounds,
    Columns,
    Indices,
    Noise,
    Priors,
    Tree,
    Update,
)
from services.biomech.whole_body.kernels.update import fuse


@compiled
def expect(x: Array, biased: bool, tree: Tree, update: Update) -> None:
    """Where the camera will see the centres, biases included, left in `update.innovation` (15, 3) m."""
    place(x[:COORDINATES], x[COORDINATES:SEEN], tree, update.pose)
    for m in range(update.innovation.shape[0]):
        for i in range(3):
            bias = x[SEEN + 3 * m + i] if biased else 0.0
            update.innovation[m, i] = update.pose.centre[m, i] + bias


@compiled
def advance(
    x: Array, P: Array, velocity: int, dt: float, density: Array, held: bool, share: float,
    centres: Array, state: Indices, swap_scale: float, swap_most: float, swap_share: float,
    tree: Tree, columns: Columns, noise: Noise, priors: Priors, wide: Bounds, bounds: Bounds, update: Update,
    estimate: Array,
) -> tuple[bool, int]:  # fmt: skip
    """One frame, in place: whether the legs were exchanged back, and how many bounds are active.

    centres (15, 3) m and state (15,) may come back exchanged; swap_share 0 never exchanges. x goes on within the `wide`
    bounds; estimate (n,) is x within `bounds`.
    """
    biased = velocity > SEEN
    if dt > 0.0:
        predict(x, P, velocity, dt, density, held)
    swapped = False
    if swap_share > 0.0:
        expect(x, biased, tree, update)
        swapped = unswap(centres, state, update.innovation, swap_scale, swap_most, swap_share)
    fuse(x, P, biased, centres, state, share, tree, columns, noise, priors, update)
    project(x, P, wide)
    estimate[:] = x
    return swapped, project(estimate, P, bounds)
