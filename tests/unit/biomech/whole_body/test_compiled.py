"""Machine code that was just compiled and the same from the disk must give the same numbers, to the last bit.

A session that begins on the first start of a service, and goes on in a process that comes after it, depends on it.
"""

import os
import pickle
import subprocess
import sys

from services.biomech.whole_body.compiled import compiled

TELL = """
import hashlib
import numpy as np
from services.biomech.whole_body.constrained_ekf import WholeBodyEkf
from services.biomech.whole_body.model import MODEL
from services.biomech.whole_body.multibody_kinematics import fit_frame
from services.biomech.whole_body.parameters import REST_DEG, lengths_of, per_angle
from services.biomech.whole_body.start import standing_start
rng, tracked, told = np.random.default_rng(0), np.full(15, 2), hashlib.sha256()
q = np.repeat(np.concatenate([np.zeros(3), per_angle(REST_DEG)[:, 0]])[None], 240, axis=0)
q[:, [9, 13]] += np.radians(40.0) * (1.0 - np.cos(np.arange(240) / 12.0))[:, None]
frames = np.array([MODEL.centres(row, lengths_of(1.7)) for row in q]) + rng.normal(0.0, 0.03, (240, 15, 3))
start = standing_start(frames[:30], np.full((30, 15), 2), 1.7)
for begin in (start, start._replace(bias_std=None)):
    ekf = WholeBodyEkf(begin)
    for frame in frames:
        ekf.advance(1.0 / 30.0, frame, tracked)
        told.update(ekf.estimate.tobytes())
    told.update(ekf.P.tobytes())
told.update(fit_frame(frames[100], tracked).q.tobytes())
print(told.hexdigest())
"""


def test_a_first_start_gives_the_numbers_of_all_later_ones(tmp_path) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    said = [
        subprocess.run(
            [sys.executable, "-c", TELL], env=environment, capture_output=True, text=True, check=True, timeout=300
        ).stdout
        for _ in range(2)
    ]
    assert len(said[0].strip()) == 64
    assert said[0] == said[1]


def test_an_index_of_types_that_are_no_more_is_stale() -> None:
    """An update may have renamed what the machine code of the version before was compiled for."""

    def twice(value: float) -> float:
        return 2.0 * value

    file = compiled(twice)._cache._cache_file
    os.makedirs(file._cache_path, exist_ok=True)
    gone = b"\x80\x04c" + b"services.biomech.whole_body.kernels.tables\nNoSuchTable\n."
    with open(file._index_path, "wb") as index:
        index.write(pickle.dumps(file._version) + gone)
    try:
        assert file._load_index() == {}
        assert compiled(twice)(1.5) == 3.0
    finally:
        os.unlink(file._index_path)
