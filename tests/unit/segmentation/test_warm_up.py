from services.segmentation.gait import leg_kinematics
from services.segmentation.warm_up import warm_up


def test_legs_are_compiled_for_what_the_node_hands_them() -> None:
    warm_up()
    kernels = [each for each in vars(leg_kinematics).values() if hasattr(each, "signatures")]
    compiled = sum(len(kernel.signatures) for kernel in kernels)
    assert compiled > 0
    warm_up()
    assert sum(len(kernel.signatures) for kernel in kernels) == compiled
