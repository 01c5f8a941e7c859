"""Joint centres as .trc: the markers that OpenSim reads."""

from collections.abc import Iterator

from services.exports.c3d.points import LABELS, MILLIMETRES
from services.exports.errors import ExportError
from services.exports.facts import Facts
from services.exports.joint_positions import joint_positions
from services.exports.motion import Motion, even_rate_hz, even_times, nominal_rates_hz, resampled
from services.exports.parameters import ROWS_AT_A_TIME
from services.exports.text_rows import cells


def marker_file(facts: Facts, motion: Motion, file_name: str) -> Iterator[bytes]:
    """The file in parts: mm, y up, x forward, even times; empty cells where a centre is not known.

    Raises ExportError where no joint centre is known.
    """
    positions = joint_positions(motion, facts.description.anthropometry)
    if positions is None:
        what = "no leg tells the angles of both hip and knee, and no camera where joints are"
        raise ExportError("joint_state.valid", what, "export .mot or c3d, which need angles only")
    times = motion.angles.times_ns
    rate_hz = even_rate_hz(times, nominal_rates_hz(facts.description))
    even = even_times(times, rate_hz)
    labels = [LABELS[name] for name in positions.names]
    yield _head(file_name, rate_hz, even.size, labels)
    for first in range(0, even.size, ROWS_AT_A_TIME):
        track = resampled(positions.track, even[first : first + ROWS_AT_A_TIME], rate_hz)
        lines = []
        for row, (time, points, told) in enumerate(
            zip(track.times_ns.tolist(), (track.value * MILLIMETRES).tolist(), track.valid.tolist(), strict=True)
        ):
            values = "\t".join(cells(point, known) for point, known in zip(points, told, strict=True))
            # OpenSim drops an empty cell that ends a line.
            end = "" if told[-1] else "\t"
            lines.append(f"{first + row + 1}\t{time * 1e-9:.6f}\t{values}{end}\n")
        yield "".join(lines).encode("ascii")


def _head(file_name: str, rate_hz: float, count: int, labels: list[str]) -> bytes:
    columns = [f"{axis}{number}" for number in range(1, len(labels) + 1) for axis in "XYZ"]
    names = "\t\t\t".join(labels)
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{file_name}",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
        f"{rate_hz:.3f}\t{rate_hz:.3f}\t{count}\t{len(labels)}\tmm\t{rate_hz:.3f}\t1\t{count}",
        f"Frame#\tTime\t{names}\t\t",
        "\t".join(["", "", *columns]),
        "",
    ]
    return ("\n".join(lines) + "\n").encode("ascii")
