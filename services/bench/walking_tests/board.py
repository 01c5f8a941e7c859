"""`ambula bench walking_tests`: walks for time and measured walks, synthetic ones with truth and recorded ones."""

from pathlib import Path

from services.bench.scoreboard import Row, Scoreboard
from services.bench.walking_tests.recordings import recording_rows
from services.bench.walking_tests.six_minutes import six_minute_rows
from services.bench.walking_tests.ten_metres import ten_metre_rows

PARTS = {"six_minutes": six_minute_rows, "ten_metres": ten_metre_rows, "recordings": recording_rows}
NOTE = (
    "Through the whole chain, against exact truth: a distance as a tester counts it, lines crossed by the ball of the "
    "foremost foot. Parameters were chosen on seeds 103 to 107; scored on people from seed 401 on. Baselines: of a "
    "distance that by strides alone, of a speed a stopwatch with 0.2 s of reaction at each line."
)


def run(json_path: Path | None, *parts: str) -> Scoreboard:
    """All parts, or those named. Raises ValueError for an unknown one."""
    unknown = [part for part in parts if part not in PARTS]
    if unknown:
        raise ValueError(f"walking_tests has the parts {', '.join(PARTS)}, not {' '.join(unknown)!r}")
    rows: list[Row] = []
    for part in parts or PARTS:
        rows += PARTS[part]()
    board = Scoreboard("Walking tests", rows, NOTE)
    if json_path is not None:
        board.write_json(json_path)
    return board
