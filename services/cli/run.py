"""`ambula run`: a recording through the nodes in a plain loop, into files."""

import json
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from schemas.gait import GaitEvent, Stride
from schemas.kinematics import Calibration, JointState
from schemas.metrics import SessionMetrics
from schemas.rhythm import LearnedRhythm
from schemas.session import SessionDescription
from services.cli.assembly import build_chain
from services.cli.interrupt import on_interrupt
from services.cli.rhythms import FILE_NAME
from services.exports.facts import STRIDES_AND_STEPS, Facts
from services.exports.tables.csv_file import CsvFile
from services.flow.chain import Chain
from services.flow.message import Message
from services.flow.software import SOFTWARE
from services.ingest.choices import AS_THE_SOURCE_SAYS, Choices
from services.ingest.driver import LiveSource
from services.ingest.source import Source, iter_messages, open_chosen

TABLES = ("joint_angles", "events", "strides")


class RunFiles:
    """The result files of one run."""

    def __init__(self, folder: Path, description: SessionDescription) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self._description = description
        self._files = [(folder / f"{name}.csv").open("w", newline="", encoding="utf-8") for name in TABLES]
        facts = Facts(description, None, SOFTWARE)
        self._tables = [CsvFile(file, name, facts) for file, name in zip(self._files, TABLES, strict=True)]
        self.metrics: SessionMetrics | None = None
        self.rhythm: LearnedRhythm | None = None

    def take(self, message: Message) -> None:
        """File one message of the chain."""
        match message.payload:
            case JointState() | GaitEvent() | Stride():
                for table in self._tables:
                    table.take(message.payload)
            case Calibration() as calibration:
                for table in self._tables:
                    table.calibrated(Facts(self._description, calibration, SOFTWARE))
            case SessionMetrics() as metrics:
                self.metrics = metrics
            case LearnedRhythm() as rhythm:
                self.rhythm = rhythm

    def close(self, header: dict[str, Any]) -> None:
        """Finish the tables, write metrics.json and, if a rhythm was learned, its file."""
        for table, file in zip(self._tables, self._files, strict=True):
            table.close()
            file.close()
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
    files = RunFiles(folder, description)
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
        "conditions": description.conditions.model_dump(mode="json", exclude_none=True),
        "known_rhythms": [{"kind": known.kind, "name": known.name} for known in description.known_rhythms],
        "definitions": STRIDES_AND_STEPS,
        "rejections": [rejection.model_dump(mode="json") for rejection in rejections],
    }
