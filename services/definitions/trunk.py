"""How regular the trunk moves, of whoever wears a lumbar sensor alone. For files only."""

from services.definitions.definition import Basis, Definition

TRUNK_STEP, TRUNK_STRIDE, TRUNK_SYMMETRY = (
    Definition(name, "1", False, sentence, basis=Basis.TRUNK, export_only=True)
    for name, sentence in (
        (
            "trunk_step_regularity",
            "Autocorrelation of the vertical acceleration of the lower back after one step, Ad1; 1: each step like the "
            "one before.",
        ),
        (
            "trunk_stride_regularity",
            "Autocorrelation of the vertical acceleration of the lower back after one stride, Ad2; 1: each stride like "
            "the one before.",
        ),
        ("trunk_symmetry", "Step regularity / stride regularity, Ad1 / Ad2; 1 is symmetric."),
    )
)

TRUNK: tuple[Definition, ...] = (TRUNK_STEP, TRUNK_STRIDE, TRUNK_SYMMETRY)
