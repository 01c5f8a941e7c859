"""`ambula run`: a recording through the nodes in a plain loop, into files."""

import json
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from schemas.gait import GaitEvent, Stride
from schemas.kinematics import JointState
from schemas.metrics import SessionMetrics
from schemas.rhythm import LearnedRhythm
from schemas.vocabulary import BODY_MODELS
from services.cli import tables
from services.cli.assembly import build_chain
from services.cli.interrupt import on_interrupt
from services.cli.rhythms import FILE_NAME
from services.flow.chain import Chain
from services.flow.message import Message
from services.flow.software import SOFTWARE
from services.ingest.choices import AS_THE_SOURCE_SAYS, Choices
from services.ingest.driver import LiveSource
from services.ingest.source import Source, iter_messages, open_chosen


class RunFiles:
    """The result files of one run."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self.angles = tables.joint_angle_table(folder / "joint_angles.csv", next(iter(BODY_MODELS)))
        self.events = tables.event_table(folder / "events.csv")
        self.strides = tables.stride_table(folder / "strides.csv")
        self.metrics: SessionMetrics | None = None
        self.rhythm: LearnedRhythm | None = None

    def take(self, message: Message) -> None:
        """File one message of the chain."""
        match message.payload:
            case JointState() as state:
                for row in tables.joint_angle_rows(state):
                    self.angles.write(row)
            case GaitEvent() as event:
                self.events.write(tables.event_row(event))
            case Stride() as stride:
                self.strides.write(tables.stride_row(stride))
            case SessionMetrics() as metrics:
                self.metrics = metrics
            case LearnedRhythm() as rhythm:
                self.rhythm = rhythm

    def close(self, header: dict[str, Any]) -> None:
        """Finish the tables, write metrics.json and, if a rhythm was learned, its file."""
        for table in (self.angles, self.events, self.strides):
            with table:
                pass
        body = {} if self.metrics is None else json.loads(self.metrics.model_dump_json())
        (self.folder / "metrics.json").write_text(json.dumps(header | body, indent=2) + "\n", encoding="utf-8")
        if self.rhythm is not None:
            (self.folder / FILE_NAME).write_text(self.rhythm.model_dump_json(indent=2) + "\n", encoding="utf-8")


def run(spec: str, folder: Path, console: Console, choices: Choices = AS_THE_SOURCE_SAYS) -> dict[str, Any]:
    """Run a source to its end, a device's to Ctrl-C; the header of metrics.json.

    Raises SourceError for a source that cannot be read.
    """
    source = open_chosen(spec, choices)
    description = source.describe()
    chain = build_chain(description)
    files = RunFiles(folder)
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[at]}"), TimeRemainingColumn())
    stop = source.stop if isinstance(source, LiveSource) else None
    with on_interrupt(stop), Progress(*columns, console=console, transient=True) as progress:
        bar = progress.add_task(description.title, total=description.duration_s, at="")
        for message in iter_messages(source):
            for produced in chain.push(message):
                files.take(produced)
            at = message.envelope.captured_ns * 1e-9
            progress.update(bar, completed=at, at=f"{at:.1f} s")
    header = _header(source, chain)
    files.close(header)
    return header


def _header(source: Source, chain: Chain) -> dict[str, Any]:
    description = source.describe()
    rejections = list(source.rejections())
    for host in chain.hosts:
        rejections += host.node.rejections()
    return {
        "software": SOFTWARE,
        "session": description.session,
        "title": description.title,
        "estimator": description.estimator,
        "walk_path": description.walk_path,
        "task": description.task,
        "walkway_m": description.walkway_m,
        "known_rhythms": [{"kind": known.kind, "name": known.name} for known in description.known_rhythms],
        "definitions": tables.STRIDE_DEFINITION,
        "rejections": [rejection.model_dump(mode="json") for rejection in rejections],
    }
