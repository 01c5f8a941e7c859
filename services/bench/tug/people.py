"""How much people differ in what one leg does not see: when the trunk begins to lead the rise. No estimator between."""

from schemas.tasks import TaskPhase
from services.bench.scoreboard import Row
from services.bench.tug.joint_tugs import joint_tug
from services.bench.tug.scores import Tally, tally_rows
from services.segmentation.node import SegmentationNode

SEEDS = range(401, 425)
"""Nothing was chosen on them."""
BATCH = 25


def people_rows() -> list[Row]:
    """One leg of two dozen people who all walk alike, from joint states that are the truth."""
    tally = Tally()
    for seed in SEEDS:
        tug = joint_tug(f"speed=1.2&rise_time=1.6&seed={seed}&worn=1&seated_start=1")
        node = SegmentationNode(tug.description)
        outputs = [output for message in tug.messages(BATCH) for output in node.step(message)] + node.finish()
        ended: dict[int, list[TaskPhase]] = {}
        for output in outputs:
            if isinstance(output.payload, TaskPhase) and output.payload.end_ns is not None:
                ended.setdefault(output.payload.attempt, []).append(output.payload)
        tally.add(tug.phases, ended)
    return tally_rows("one leg of 24 people", tally)
