"""What runs per frame is compiled before the first frame comes."""

import numpy as np

from services.biomech.rhythm.trusted import advance_and_read
from services.biomech.whole_body.kernels.fit import fit
from services.biomech.whole_body.kernels.frame import advance
from services.biomech.whole_body.kernels.kinematics import place_alone
from services.estimation.body.warm_up import warm_up
from tests.unit.estimation.body import body_sessions as sessions

KERNELS = (advance, place_alone, fit, advance_and_read)


def test_nothing_is_left_to_compile():
    warm_up()
    compiled = [len(each.signatures) for each in KERNELS]
    assert min(compiled) > 0
    q = np.concatenate([sessions.squats(4.0)[20:], sessions.standing(1.5), sessions.squats(2.0)])
    away = [None if 150 <= k < 170 else 1 for k in range(len(q))]
    outputs = sessions.run(sessions.node(), sessions.messages(sessions.seen(q), body=away))
    assert [c.absolute for c in sessions.calibrations(outputs)][-1]
    assert [len(each.signatures) for each in KERNELS] == compiled
