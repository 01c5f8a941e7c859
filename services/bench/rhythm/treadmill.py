"""A stroke survivor on a treadmill: the rhythm of two shank gyroscopes against swing peaks found offline."""

import csv
import gzip
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, find_peaks, sosfiltfilt

from services.bench.rhythm.motions import INTERVAL_S
from services.bench.rhythm.scores import LOCKED, PHASE, RIGHT, WRONG
from services.ingest.data import find_data

RECORDING = "moving_reality_stroke"
FILES = ("pp11_leftshank.csv.gz", "pp11_rightshank.csv.gz")
WINDOW_STRIDES = 3
SHORTEST_STRIDE_S = 0.7

FloatArray = NDArray[np.float64]


class CadenceScore(NamedTuple):
    """Windows of three strides, from swing peak to swing peak, of all sides."""

    right_percent: float
    """Cadence within 2 %, locked throughout."""
    wrong_percent: float
    """Locked throughout and more than 5 % off."""
    locked_percent: float
    """Of the time after the first lock."""
    phase_spread_deg: float
    """Half the range of the central 68 % of the phase at swing peaks while locked, mean of the sides."""


def load_shank_rates() -> FloatArray:
    """Swing rates of left and right shank, rad/s, (n, 2): gyro about its own principal axis, swing positive.

    Raises:
        MissingFile: the recording is not on this machine.
    """
    folder = find_data(RECORDING)
    rates = [_swing_rate(_read_gyro(folder / name)) for name in FILES]
    length = min(rate.size for rate in rates)
    return np.stack([rate[:length] for rate in rates], axis=1)


def _read_gyro(path: Path) -> FloatArray:
    with gzip.open(path, "rt") as file:
        rows = csv.DictReader(file)
        return np.array([[float(row[f"gyr_{axis}"]) for axis in "xyz"] for row in rows])


def _swing_rate(gyro: FloatArray) -> FloatArray:
    """The mediolateral rate is what varies most; forward swing is its faster direction."""
    centred = gyro - gyro.mean(axis=0)
    rate = gyro @ np.linalg.svd(centred, full_matrices=False)[2][0]
    return np.asarray(rate * np.sign(np.percentile(rate, 99) + np.percentile(rate, 1)))


def swing_peaks(rate: FloatArray) -> NDArray[np.int64]:
    """Samples of mid-swing, found with the whole recording known."""
    smooth = sosfiltfilt(butter(2, 5.0, fs=1.0 / INTERVAL_S, output="sos"), rate)
    height = 0.5 * np.percentile(smooth, 98)
    return np.asarray(find_peaks(smooth, height=height, distance=int(SHORTEST_STRIDE_S / INTERVAL_S))[0])


def score_cadence(readings: FloatArray, rates: FloatArray) -> CadenceScore:
    """Score readings (n, 4) against the swing peaks of each shank, from the first peak on."""
    locked = readings[:, LOCKED] > 0.5
    errors, spreads = [], []
    for rate in rates.T:
        peaks = swing_peaks(rate)
        for start, end in zip(peaks, peaks[WINDOW_STRIDES:], strict=False):
            if end <= np.argmax(locked):
                continue
            turns = (readings[end, PHASE] - readings[start, PHASE]) / (2.0 * np.pi)
            errors.append(abs(turns / WINDOW_STRIDES - 1.0) if locked[start : end + 1].all() else np.nan)
        turned = np.exp(1j * readings[peaks[locked[peaks]], PHASE])
        around = np.degrees(np.angle(turned * np.conj(turned.mean())))
        spreads.append(0.5 * (np.percentile(around, 84) - np.percentile(around, 16)))
    error = np.array(errors)
    return CadenceScore(
        right_percent=100.0 * float(np.mean(error < RIGHT)),
        wrong_percent=100.0 * float(np.mean(error > WRONG)),
        locked_percent=100.0 * float(np.mean(locked[np.argmax(locked) :])),
        phase_spread_deg=float(np.mean(spreads)),
    )
