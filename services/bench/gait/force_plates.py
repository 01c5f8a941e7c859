"""Contacts of two feet with two force plates, walk by walk: the truth for event times (ZJU recordings)."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import GaitEventKind, Side
from services.ingest.data import find_data
from services.ingest.table import read_table

Array = NDArray[np.float64]

DATA = "zju_shank_imu_gait"
LOADED_N = 20.0
"""N of vertical force above which a foot is on the plate."""
SETTLED_S = 0.01
"""s for which a plate must stay loaded or unloaded: the force rings when a foot comes and goes."""
FRAME_S = 0.01
SUBFRAMES = 10


class PlateWalk(NamedTuple):
    """One walk across the plates. Left foot on plate 1, right foot on plate 2."""

    subject: str
    trial: str
    contact_s: dict[tuple[Side, GaitEventKind], float]

    @property
    def condition(self) -> str:
        """Norm, Slow, Fast or Lmin."""
        return self.trial.partition("_")[0]


def plate_walks(subject: str) -> list[PlateWalk]:
    """All walks of a subject, with every plate event that was recorded. Raises a SourceError without the data."""
    folder = find_data(f"{DATA}/{subject}")
    files = sorted(folder.glob("*_forces.csv.gz"))
    return [_walk(subject, path.name.removesuffix("_forces.csv.gz"), path) for path in files]


def manifest_of(template: Path, walk: PlateWalk) -> str:
    """The manifest of one walk: that of another walk, with the names of subject and trial replaced."""
    text = re.sub(r"[A-Z][a-z]+_\d\d_imu", f"{walk.trial}_imu", template.read_text(encoding="utf-8"))
    return re.sub(rf"{DATA}/S\d\d", f"{DATA}/{walk.subject}", text)


def settled_edges(time_s: Array, force: Array, *, rising: bool) -> Array:
    """Times (k,) s at which a plate's force (n,) N passes LOADED_N and stays beyond it for SETTLED_S."""
    loaded = force > LOADED_N
    steps = np.flatnonzero(np.diff(loaded.astype(np.int8)) == (1 if rising else -1)) + 1
    # At the end of the file nobody knows whether it stays.
    steps = steps[time_s[steps] + SETTLED_S <= time_s[-1]]
    stays = [bool(np.all(loaded[(time_s >= at) & (time_s < at + SETTLED_S)] == rising)) for at in time_s[steps]]
    edges: Array = time_s[steps][np.array(stays, dtype=np.bool_)]
    return edges


def _walk(subject: str, trial: str, path: Path) -> PlateWalk:
    frame, subframe, first, second = read_table(path, ("frame", "subframe", "p1_Fz_N", "p2_Fz_N")).values.T
    time_s = (frame - 1 + subframe / SUBFRAMES) * FRAME_S
    # The plates count a load negative.
    found = {
        (Side.LEFT, GaitEventKind.TOE_OFF): settled_edges(time_s, -first, rising=False)[-1:],
        (Side.RIGHT, GaitEventKind.INITIAL_CONTACT): settled_edges(time_s, -second, rising=True)[:1],
        (Side.RIGHT, GaitEventKind.TOE_OFF): settled_edges(time_s, -second, rising=False)[-1:],
    }
    return PlateWalk(subject, trial, {key: float(edges[0]) for key, edges in found.items() if len(edges)})
