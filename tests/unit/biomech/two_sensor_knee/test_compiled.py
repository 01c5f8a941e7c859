"""Machine code that was just compiled and the same from the disk must give the same numbers, to the last bit.

A session that begins on the first start of a service, and goes on in a process that comes after it, depends on it.
"""

import os
import subprocess
import sys

TELL = """
import hashlib
import numpy as np
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
rng, time_s = np.random.default_rng(0), np.arange(3000) / 100
rate, force = rng.normal(0.0, 0.01, (3000, 2, 3)), rng.normal(0.0, 0.1, (3000, 2, 3))
rate[:, 0, 2] += 1.2 * np.sin(2 * np.pi * time_s)
rate[:, 1, 2] += 2.3 * np.sin(2 * np.pi * time_s + 1.0)
force[:, :, 1] += 9.81
print(hashlib.sha256(KneeAxis().run(rate, force, 0.01).tobytes()).hexdigest())
"""


def test_a_first_start_gives_the_numbers_of_all_later_ones(tmp_path):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    said = [
        subprocess.run(
            [sys.executable, "-c", TELL], env=environment, capture_output=True, text=True, check=True, timeout=300
        ).stdout
        for _ in range(2)
    ]
    assert len(said[0].strip()) == 64
    assert said[0] == said[1]
