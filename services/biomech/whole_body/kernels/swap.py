"""Left and right leg exchanged by the camera for some frames."""

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.tables import Array, Indices

LEG = 9
"""First centre of the right leg; the left leg's follow three behind."""


@compiled
def misfit(measured: Array, expected: Array, a: int, b: int, scale: float, most: float) -> float:
    """Squared distance of measured[a] from expected[b] in units of `scale`, no more than `most` per axis."""
    total = 0.0
    for i in range(3):
        e = (measured[a, i] - expected[b, i]) / scale
        total += min(e * e, most)
    return total


@compiled
def unswap(centres: Array, state: Indices, expected: Array, scale: float, most: float, share: float) -> bool:
    """Exchange the legs in place if that fits what is expected (15, 3) better than `share` of the misfit as given.

    Only centres tracked on both sides are compared.
    """
    given, exchanged = 0.0, 0.0
    for m in range(LEG, LEG + 3):
        if state[m] == 0 or state[m + 3] == 0:
            continue
        given += misfit(centres, expected, m, m, scale, most) + misfit(centres, expected, m + 3, m + 3, scale, most)
        exchanged += misfit(centres, expected, m + 3, m, scale, most) + misfit(centres, expected, m, m + 3, scale, most)
    if not exchanged < share * given:
        return False
    for m in range(LEG, LEG + 3):
        state[m], state[m + 3] = state[m + 3], state[m]
        for i in range(3):
            centres[m, i], centres[m + 3, i] = centres[m + 3, i], centres[m, i]
    return True
