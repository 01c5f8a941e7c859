"""What runs per sample is compiled before the first sample comes."""

from services.biomech.two_sensor_knee.flexion import angle_of_verticals
from services.biomech.two_sensor_knee.sample import advance_many
from services.estimation.knee.node import KneeNode
from services.estimation.knee.warm_up import warm_up
from tests.unit.estimation.knee import knee_legs as legs


def test_nothing_is_left_to_compile():
    warm_up()
    compiled = [len(each.signatures) for each in (advance_many, angle_of_verticals)]
    outputs = legs.run(
        KneeNode(legs.describe()), legs.marked(legs.messages(legs.leg(seconds=12.0), ticks=5), 0.5, 2.5, 2.6)
    )
    assert legs.states(outputs)
    assert legs.calibrations(outputs)[0].datum.startswith("the standing that was marked")
    assert [len(each.signatures) for each in (advance_many, angle_of_verticals)] == compiled
