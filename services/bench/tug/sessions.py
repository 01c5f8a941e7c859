"""Sessions through the whole estimation chain and the segmenter, and what came of them."""

from collections.abc import Iterator
from dataclasses import dataclass

from schemas.tasks import TaskPhase
from schemas.vocabulary import Task
from services.cli.assembly import NODES
from services.flow.chain import Chain
from services.flow.host import HostedNode
from services.flow.message import Message
from services.ingest.source import iter_messages, open_source
from services.ingest.synthetic.motions import parse_motion
from services.ingest.synthetic.tug import SyntheticTug

WORN = {0: "pelvis and both legs", 1: "left leg", 2: "right leg", 3: "pelvis alone"}
"""What is worn, by the dial of the synthetic sessions."""

COMPARED = ("estimation", "segmentation")


@dataclass(frozen=True)
class Case:
    """One way of doing the test: dials of `synthetic:tug` without seed and sensors."""

    name: str
    dials: str
    impaired: bool = False


CASES = (
    Case("0.4 m/s", "speed=0.4&turn_time=4&turn_steps=4&rise_time=2.5"),
    Case("0.6 m/s", "speed=0.6&turn_time=3&turn_steps=3"),
    Case("0.8 m/s", "speed=0.8&rise_time=1.4"),
    Case("1.0 m/s", "speed=1.0"),
    Case("1.2 m/s", "speed=1.2&turn_time=1.6&turn_steps=1"),
    Case("1.4 m/s", "speed=1.4&rise_time=1.2&turn_time=1.5"),
    Case("skin moves", "speed=1.1&turn_steps=3&soft_tissue=0.06"),
    Case("restless, up twice, given up once", "speed=0.9&fidget=0.06&false_starts=1&aborted=1"),
    Case("stops before the turn", "speed=0.7&hesitation=2&turn_time=3&turn_steps=4", impaired=True),
    Case("one-sided, slow to rise", "speed=0.5&asymmetry=0.3&rise_time=3.5&sit_time=3&turn_time=5", impaired=True),
    Case("turns in six parts", "speed=0.45&turn_time=6&turn_steps=6&rise_time=2.5", impaired=True),
)

FIRST_SCORED_SEED, PEOPLE_PER_CASE = 311, 2
"""Nothing was chosen on the scored people; the parameters rest on seeds 3 and 100 to 115, of other cases."""


def seeds_of(case: Case) -> range:
    """The people who do a case; nobody does two."""
    first = FIRST_SCORED_SEED + PEOPLE_PER_CASE * CASES.index(case)
    return range(first, first + PEOPLE_PER_CASE)


def spec_of(case: Case, seed: int, worn: int) -> str:
    """Sessions of a single leg begin on the chair; the others stand first."""
    seated = "&seated_start=1" if worn in (1, 2) else ""
    return f"synthetic:tug?{case.dials}&seed={seed}&worn={worn}{seated}"


def truth_of(spec: str) -> SyntheticTug:
    """The session behind a specification."""
    motion, _, options = spec.removeprefix("synthetic:").partition("?")
    session = parse_motion(motion, options)
    assert isinstance(session, SyntheticTug)
    return session


def estimated(spec: str) -> Iterator[Message]:
    """What estimation and segmentation send for a source whose task is the timed up and go."""
    source = open_source(spec, session="tug", task=Task.TIMED_UP_AND_GO)
    description = source.describe()
    chain = Chain([HostedNode(name, description.session, NODES[name](description)) for name in COMPARED])
    for message in iter_messages(source):
        yield from chain.push(message)


def ended_phases(messages: Iterator[Message]) -> dict[int, list[TaskPhase]]:
    """The phases that ended, in order, by attempt."""
    attempts: dict[int, list[TaskPhase]] = {}
    for message in messages:
        if isinstance(message.payload, TaskPhase) and message.payload.end_ns is not None:
            attempts.setdefault(message.payload.attempt, []).append(message.payload)
    return attempts
