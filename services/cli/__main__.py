"""The ambula command."""

import inspect
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, Progress, TextColumn
from rich.table import Table

from schemas.metrics import SessionMetrics
from schemas.rhythm import KnownRhythm
from schemas.session import WalkPath
from services.cli.audit import audit
from services.cli.backup.command import backup, restore
from services.cli.conditions import Conditioned, read_conditions
from services.cli.console import err, out, told
from services.cli.export import export
from services.cli.options import Asked, Estimator, Rhythm, Source, Straight, Walkway
from services.cli.report import report
from services.cli.reprocess.command import reprocess
from services.cli.send_skeletons import send_skeletons
from services.cli.tune import tune
from services.ingest.choices import Choices

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    help="Joint angles, gait events and honest progress from body-worn IMUs. Research software, not a medical device.",
)


def _version(wanted: bool) -> None:
    if wanted:
        from services.flow.software import SOFTWARE

        out.print(SOFTWARE)
        raise typer.Exit


@app.callback()
def options(
    show_version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="print the version and stop")
    ] = False,
) -> None:
    """Options before any command."""


@app.command()
def up(
    demo: Annotated[bool, typer.Option("--demo", help="also start synthetic patients and a recorded walk")] = False,
    seconds: Annotated[float | None, typer.Option("--for", help="stop by itself after so many seconds")] = None,
) -> None:
    """Start all services on this machine and keep them running until Ctrl-C."""
    from services.cli.up import run_stack

    raise typer.Exit(run_stack(demo=demo, seconds=seconds))


@app.command()
def replay(
    path: Source,
    speed: Annotated[str, typer.Option(help="1 = as recorded, 10 = ten times as fast, max = as fast as it goes")] = "1",
    estimator: Estimator = None,
    straight: Straight = None,
    task: Asked = None,
    walkway: Walkway = None,
    conditions: Conditioned = None,
    previous_trial: Rhythm = None,
    previous_visit: Rhythm = None,
    exemplar: Rhythm = None,
) -> None:
    """Play a recording through the running services, as if the sensors were worn now."""
    from services.bus.connection import Bus, BusUnavailable
    from services.bus.settings import BusSettings
    from services.cli import live, show

    with (
        told(BusUnavailable, live.NotStarted, live.WentSilent, ValueError),
        Bus.open(BusSettings(), "replay") as bus,
        live.Watch(bus) as watch,
    ):
        pace = None if speed == "max" else _positive(speed)
        known = _known(previous_trial, previous_visit, exemplar)
        said = read_conditions(conditions)
        choices = Choices(estimator, _walk_path(straight), known, task, walkway, said)
        description = live.start_session(bus, _absolute(path), pace, choices)
        err.print(f"session {description.session}: {description.title}")
        with Progress(
            TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[at]}"), console=err
        ) as bar:
            replaying = bar.add_task("replaying", total=description.duration_s, at="")
            for news in live.followed(bus, watch, description):
                if isinstance(news, SessionMetrics):
                    out.print(show.metrics_table(news, description.title))
                else:
                    bar.update(replaying, completed=news, at=f"{news:.1f} s")


@app.command()
def mark(
    session: Annotated[str, typer.Argument(help="id of a running session, as `ambula replay` and the page show it")],
    last: Annotated[float, typer.Option(help="s of standing that lie behind, 1 to 10")] = 3.0,
) -> None:
    """Mark the last seconds of a running session as standing; the live page says whether they were."""
    from services.bus.connection import Bus, BusUnavailable
    from services.bus.settings import BusSettings
    from services.cli import live

    with told(BusUnavailable, live.NotStarted), Bus.open(BusSettings(), "mark") as bus:
        from_s, to_s = live.mark_standing(bus, session, last)
    out.print(f"marked as standing: {from_s:.1f} to {to_s:.1f} s")


@app.command()
def run(
    path: Source,
    folder: Annotated[Path, typer.Option("--out", help="folder for the results; made when it is missing")],
    estimator: Estimator = None,
    straight: Straight = None,
    task: Asked = None,
    walkway: Walkway = None,
    conditions: Conditioned = None,
    previous_trial: Rhythm = None,
    previous_visit: Rhythm = None,
    exemplar: Rhythm = None,
) -> None:
    """Run a recording through the same nodes in a plain loop and write CSV and JSON files."""
    from services.cli.rhythms import NoRhythm
    from services.cli.run import run as run_source
    from services.ingest.errors import SourceError

    with told(SourceError, NoRhythm, OSError, ValueError):
        known = _known(previous_trial, previous_visit, exemplar)
        said = read_conditions(conditions)
        run_source(path, folder, err, Choices(estimator, _walk_path(straight), known, task, walkway, said))
    out.print(f"written: {folder}/joint_angles.csv, events.csv, strides.csv, metrics.json")


@app.command()
def exemplar(
    session: Annotated[Path, typer.Argument(help="folder of an archived session, or of ambula run")],
    file: Annotated[Path, typer.Option("--out", help="JSON file to write")],
) -> None:
    """Write the learned rhythm of a session to a file, to compare other sessions with (run --exemplar FILE)."""
    from services.cli.rhythms import NoRhythm, read_rhythm

    with told(NoRhythm, OSError):
        rhythm = read_rhythm(session)
        file.write_text(rhythm.model_dump_json(indent=2) + "\n", encoding="utf-8")
    out.print(f"written: {file}, the mean of {rhythm.strides} strides")


@app.command()
def synth(
    folder: Annotated[Path, typer.Option("--out", help="folder for the recording; made when it is missing")],
    walk: Annotated[str, typer.Option(help="as in a source name, e.g. speed=1.3&seed=7 or patient=steppage")] = "",
    march: Annotated[str | None, typer.Option(help="march on the spot instead, e.g. metronome=70&seed=7")] = None,
    tug: Annotated[str | None, typer.Option(help="a timed up and go instead, e.g. walkway=3&seed=7")] = None,
    knee: Annotated[str | None, typer.Option(help="an exercise of a knee instead, e.g. exercise=1&seed=7")] = None,
    motion: Annotated[str | None, typer.Option(help="any other, as in a source, e.g. squat?hold=1&seed=7")] = None,
    straight: Straight = None,
) -> None:
    """Write what a synthetic person does, walking unless said otherwise, with its truth as a recording folder."""
    from services.ingest.errors import SourceError
    from services.ingest.synthetic import write_recording

    with told(SourceError, OSError):
        asked = {"march": march, "tug": tug, "knee": knee}
        name, options = next(((name, said) for name, said in asked.items() if said is not None), ("walk", walk))
        if motion is not None:
            name, _, options = motion.partition("?")
        write_recording(folder, options, _walk_path(straight) or "turning", motion=name)
    out.print(f"written: {folder}/recording.toml and its CSV files; try: ambula run {folder} --out out")


app.command()(send_skeletons)
app.command()(export)
app.command()(report)
app.command()(reprocess)
app.add_typer(audit, name="audit")


@app.command(context_settings={"ignore_unknown_options": True})
def bench(
    name: Annotated[str | None, typer.Argument(help="which scoreboard; without a name they are listed")] = None,
    subject: Annotated[
        list[str] | None, typer.Argument(help="what to measure it on, e.g. neura, or 100 tables")
    ] = None,
    json_path: Annotated[Path | None, typer.Option("--json", help="also write the rows to this file")] = None,
    details: Annotated[bool, typer.Option("--all", help="print every row, e.g. each side by itself")] = False,
    report: Annotated[Path | None, typer.Option(help="folder for a report with charts, where there is one")] = None,
) -> None:
    """Measure a claim and print it beside its target and its baseline."""
    from services.bench.registry import SCOREBOARDS

    if name is None or name not in SCOREBOARDS:
        if name is not None:
            err.print(f"[red]Error:[/red] there is no scoreboard {name!r}")
        for known, board in SCOREBOARDS.items():
            out.print(f"{known:16} {(board.__doc__ or '').splitlines()[0]}")
        raise typer.Exit(name is not None)
    board = SCOREBOARDS[name]
    with told(ValueError, OSError):
        if report is not None and "report" not in inspect.signature(board).parameters:
            raise ValueError(f"{name} writes no report; leave --report out, --json writes its rows")
        options = {} if report is None else {"report": report}
        subjects = subject or []
        try:
            inspect.signature(board).bind(json_path, *subjects, **options)
        except TypeError:
            raise ValueError(f"{name} cannot be measured on {' '.join(subjects)!r}; try ambula bench {name}") from None
        result = board(json_path, *subjects, **options)
        result.print(details=details)


@app.command()
def doctor(
    service: Annotated[str | None, typer.Option(help="only: is this service alive? Exit code 0 or 1")] = None,
    deep: Annotated[bool, typer.Option("--deep", help="also compare the checksum of every recording")] = False,
) -> None:
    """Check this machine and the running services; say what to do where something is missing."""
    from services.cli.doctor.examine import examine
    from services.cli.doctor.findings import MARKS
    from services.cli.doctor.stack import service_is_alive

    if service is not None:
        raise typer.Exit(0 if service_is_alive(service) else 1)
    table = Table(show_header=False)
    findings = list(examine(deep=deep))
    for finding in findings:
        table.add_row(MARKS[finding.ok], finding.subject, finding.says)
    out.print(table)
    raise typer.Exit(any(finding.ok is False for finding in findings))


app.command()(tune)
app.command()(backup)
app.command()(restore)


def _positive(text: str) -> float:
    try:
        speed = float(text)
    except ValueError:
        raise ValueError(f"--speed takes a number or max, not {text!r}") from None
    if speed <= 0:
        raise ValueError(f"--speed must be more than 0, not {text}")
    return speed


def _known(
    previous_trial: Path | None, previous_visit: Path | None, exemplar: Path | None
) -> tuple[KnownRhythm, ...] | None:
    from services.cli.rhythms import read_known

    known = read_known({"previous trial": previous_trial, "previous visit": previous_visit, "exemplar": exemplar})
    return None if known is None else tuple(known)


def _walk_path(straight: bool | None) -> WalkPath | None:
    return None if straight is None else "straight" if straight else "turning"


def _absolute(path: str) -> str:
    """The services may run in another folder: a path that exists here is sent in full."""
    return str(Path(path).resolve()) if Path(path).exists() else path


def main() -> None:
    """Entry point."""
    app()


if __name__ == "__main__":
    main()
