"""What a frame costs: our filter, the same in plain numpy, the bounded fit; and how exact the projection is."""

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from schemas.signals import SKELETON
from schemas.skeleton import SkeletonBatch
from services.bench.scoreboard import Row, at_most, informative
from services.biomech.whole_body import textbook
from services.biomech.whole_body.constrained_ekf import OURS, WholeBodyEkf
from services.biomech.whole_body.model import MODEL
from services.biomech.whole_body.multibody_kinematics import fit_frame
from services.biomech.whole_body.parameters import REST_DEG, lengths_of, per_angle
from services.biomech.whole_body.start import Start, standing_start
from services.estimation.node import build
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]

NOTE = "cost: processor time, least of many repetitions, one core; compile times are in the README"
SESSION = "synthetic:squat"
DT_S = 1.0 / 30.0
TRACKED = np.full(15, 2)


def least_us(run: Callable[[], object], times: int, repeats: int) -> float:
    """Shortest mean processor time of one run, us."""
    run()
    best = np.inf
    for _ in range(repeats):
        begun = time.process_time()
        for _ in range(times):
            run()
        best = min(best, (time.process_time() - begun) / times)
    return 1e6 * best


def _standing() -> tuple[Array, Start]:
    q = np.concatenate([np.zeros(3), per_angle(REST_DEG)[:, 0]])
    centres = MODEL.centres(q, lengths_of(1.7))
    still = np.repeat(centres[None], 30, axis=0)
    return centres, standing_start(still, np.full((30, 15), 2), 1.7)


def cost_rows() -> list[Row]:
    """Time of a frame with and without bias states, beside plain numpy, and of one bounded fit."""
    centres, start = _standing()
    rows = []
    for name, begin, limit in (("with", start, 100.0), ("without", start._replace(bias_std=None), 60.0)):
        ekf = WholeBodyEkf(begin, OURS)
        ours = least_us(lambda ekf=ekf: ekf.advance(DT_S, centres, TRACKED), 10, 200)  # type: ignore[misc]
        plain = least_us(lambda ekf=ekf: _textbook_frame(ekf, centres), 5, 8)  # type: ignore[misc]
        rows.append(at_most(f"cost: frame {name} bias states, {len(ekf.x)} states", ours, "us", limit, plain))
    fitted = least_us(lambda: fit_frame(centres, TRACKED, 1.7), 3, 8)
    rows.append(informative("cost: bounded fit of one frame from rest, lengths free", fitted, "us"))
    return [*rows, informative("cost: whole node, a frame a message, its messages and pictures", node_us(), "us")]


def node_us() -> float:
    """us of processor time for a frame of simulated squats through the estimation node; the least of a few runs."""
    source = open_source(SESSION)
    messages = [
        m for m in iter_messages(source) if m.stream.signal is SKELETON and isinstance(m.payload, SkeletonBatch)
    ]
    frames = sum(len(m.payload.captured_ns) for m in messages if isinstance(m.payload, SkeletonBatch))

    def run() -> None:
        node = build(source.describe())
        for message in messages:
            node.step(message)

    return least_us(run, 1, 4) / frames


def _textbook_frame(ekf: WholeBodyEkf, centres: Array) -> None:
    """One frame of the same filter in plain numpy, from where it stands; the result is dropped."""
    n = len(ekf.x)
    F = textbook.transition(n, DT_S)
    P = F @ ekf.P @ F.T + textbook.process_noise(n, DT_S, OURS.process.densities(), held=False)
    textbook.update(MODEL, F @ ekf.x, P, centres, np.full(15, OURS.camera.variance))
