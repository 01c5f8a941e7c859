"""`ambula tune`: the filter of a depth camera, tuned on simulated people."""

from pathlib import Path
from typing import Annotated

import typer

from services.cli.console import err, out, told

WAYS = ("published", "ours", "hidden")


def tune(
    way: Annotated[
        list[str] | None,
        typer.Option(
            help="published: Q of the paper's filter against the truth (eq. 8); ours: Q of ours against the truth;"
            " hidden: R and Q of ours without the truth. May be given several times; default: all",
            show_default=False,
        ),
    ] = None,
    task: Annotated[
        list[int] | None,
        typer.Option(min=1, max=4, help="1 squat with arms, 2 steps, 3 tilt forward, 4 tilt aside; default: all",
                     show_default=False),
    ] = None,
    person: Annotated[int, typer.Option(min=0, help="simulated person to tune on; 1 to 7 are scored")] = 0,
    camera: Annotated[str, typer.Option(help="noise of the camera: clinic or paper")] = "clinic",
    processes: Annotated[int, typer.Option(min=1, help="how many at once, each with one trial")] = 2,
    file: Annotated[
        Path | None, typer.Option("--out", help="also write the table of presets, a Python module, to this file")
    ] = None,
) -> None:  # fmt: skip
    """Tune the whole-body filter on one simulated person, each task for itself, and score it on seven others."""
    from services.bench.kinect.tuning_board import Order, run
    from services.ingest.errors import MissingFile

    ways, tasks = tuple(way or WAYS), tuple(task or (1, 2, 3, 4))
    with told(ValueError, OSError, MissingFile):
        for name, value, known in (*(("--way", one, WAYS) for one in ways), ("--camera", camera, ("clinic", "paper"))):
            if value not in known:
                raise ValueError(f"{name} takes one of {', '.join(known)}, not {value!r}")
        try:
            run(Order(ways, tasks, person, camera, processes), out, file)  # type: ignore[arg-type]
        except KeyboardInterrupt:
            err.print("stopped; nothing was written")
            raise typer.Exit(130) from None
    if file is not None:
        out.print(f"written: {file}")
