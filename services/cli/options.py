"""What several commands take alike."""

from pathlib import Path
from typing import Annotated

import typer

from schemas.vocabulary import ESTIMATORS, Task

Source = Annotated[
    str,
    typer.Argument(
        metavar="PATH",
        help="A folder with a recording.toml, an .mcap file of Ambula, the name of a shipped manifest"
        " (neura_s02_walk), synthetic:walk?speed=1.1&seed=3, synthetic:walk?patient=hemiparetic&speed=0.4,"
        " synthetic:march?metronome=70&seed=3,"
        " synthetic:six_minutes?corridor=30&seed=3, synthetic:ten_metres?seed=3,"
        " synthetic:tug?seed=3, synthetic:knee?exercise=1&seed=3 or synthetic:squat?seed=3;"
        " or a Kinect: device:kinect?port=7788",
    ),
]
Estimator = Annotated[
    str | None,
    typer.Option(help=f"one of {', '.join(ESTIMATORS)}; default as the recording says"),
]
Straight = Annotated[
    bool | None,
    typer.Option(
        "--straight/--turning",
        help="straight: treadmill, in place, corridor without a turn; default: as the recording says, else turning",
        show_default=False,
    ),
]
Asked = Annotated[
    Task | None,
    typer.Option(help="what the person does; default: as the recording says, else walk", show_default=False),
]
Walkway = Annotated[
    float | None,
    typer.Option(
        metavar="METRES",
        help="from the chair to the marker of a timed up and go; of a corridor or walkway its length",
        show_default=False,
    ),
]
Rhythm = Annotated[
    Path | None,
    typer.Option(
        metavar="PATH",
        help="what was learned then: a JSON file, the folder of an archived session or of ambula run",
        show_default=False,
    ),
]
