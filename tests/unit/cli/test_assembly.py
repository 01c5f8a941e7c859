"""Whatever a session wears and does, its nodes close every stream that their readers and the archive wait for."""

import pytest

from schemas.signals import SIGNALS
from services.cli.assembly import build_chain
from services.ingest.source import open_source

WALK = "synthetic:walk?duration=8"


@pytest.mark.parametrize(
    ("spec", "estimator"),
    [
        (WALK, "rhythmic_ekf"),
        (WALK + "&worn=1", "knee_axis"),
        (WALK + "&worn=3", "rhythmic_ekf"),
        ("synthetic:tug", "rhythmic_ekf"),
    ],
)
def test_every_node_has_the_outputs_of_its_service_in_the_table(spec, estimator):
    for host in build_chain(open_source(spec, estimator=estimator).describe()).hosts:
        assert set(host.node.outputs) == {signal for signal in SIGNALS if signal.producer == host.service}


def test_so_does_the_node_of_an_estimator_that_cannot_work():
    description = open_source(WALK + "&worn=3").describe().model_copy(update={"estimator": "knee_axis"})
    estimation, *_ = build_chain(description).hosts
    assert {signal.name for signal in estimation.node.outputs} == {
        s.name for s in SIGNALS if s.producer == "estimation"
    }
