from services.biomech.kernels.step import step
from services.estimation.lower_body.warm_up import warm_up


def test_one_compiled_form_serves_all_estimators() -> None:
    """A second signature would be compiled in the middle of a session."""
    warm_up()
    before = len(step.signatures)
    warm_up()
    assert len(step.signatures) == before
