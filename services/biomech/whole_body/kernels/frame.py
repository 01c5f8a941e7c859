"""One frame of the filter: predict, recognise exchanged legs, fuse, keep within bounds."""

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.kinematics import place
from services.biomech.whole_body.kernels.prediction import predict
from services.biomech.whole_body.kernels.projection import project
from services.biomech.whole_body.kernels.swap import unswap
from services.biomech.whole_body.kernels.tables import COORDINATES, SEEN, Array, Indices, Record, Table
from services.biomech.whole_body.kernels.update import fuse


@compiled
def expect(x: Array, biased: bool, body: Record, work: Record) -> None:
    """Where the camera will see the centres, biases included, left in `work.expected` (15, 3) m."""
    place(x[:COORDINATES], x[COORDINATES:SEEN], body, work.pose)
    for m in range(work.expected.shape[0]):
        for i in range(3):
            bias = x[SEEN + 3 * m + i] if biased else 0.0
            work.expected[m, i] = work.pose.centre[m, i] + bias


@compiled
def keep_there(centres: Array, state: Indices) -> int:
    """Centres (15, 3) that are not finite count as not tracked; how many there are."""
    count = 0
    for m in range(state.size):
        total = centres[m, 0] + centres[m, 1] + centres[m, 2]
        if total - total != 0.0:
            state[m] = 0
        count += state[m] > 0
    return count


@compiled
def advance(
    x: Array, P: Array, estimate: Array, velocity: int, dt: float, share: float, centres: Array, state: Indices,
    bodies: Table, beliefs: Table, works: Table,
) -> tuple[int, bool, int]:  # fmt: skip
    """One frame, in place: how many centres there are, whether legs were exchanged back, how many bounds are active.

    centres (15, 3) m and state (15,) may come back exchanged. x goes on within the wide bounds; estimate (n,) is x
    within the bounds of what is told. The tables are (1,): BODY, BELIEF and WORK.
    """
    body, belief, work = bodies[0], beliefs[0], works[0]
    biased = velocity > SEEN
    if dt > 0.0:
        predict(x, P, velocity, dt, belief)
    count = keep_there(centres, state)
    expect(x, biased, body, work)
    swapped = False
    if belief.swap_share > 0.0:
        swapped = unswap(centres, state, work.expected, belief.swap_scale, belief.swap_most, belief.swap_share)
    fuse(x, P, biased, centres, state, share, body, belief, work)
    project(x, P, belief.wide_low, belief.wide_high, work.bounds)
    for k in range(x.size):
        estimate[k] = x[k]
    return count, swapped, project(estimate, P, belief.low, belief.high, work.bounds)
