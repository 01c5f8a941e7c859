"""The library mobgap as a baseline for contacts by the lower back, where it is installed.

It is told where the walking is, and looks at each bout as a whole: an easier task than the live one.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Side

Array = NDArray[np.float64]


def library_contacts_s(
    samples: Array, bouts_s: Sequence[tuple[float, float]], rate_hz: float
) -> dict[Side, Array] | None:
    """Contacts (n,) s of each foot in bouts of walking (start, end), s; None where mobgap is not installed.

    samples (n, 6) in g and deg/s, x up, y right, z forward: mobgap's body frame. Contacts by McCamley 2012 in the
    form of Ionescu 2020, sides by the trained classifier of Ullrich 2021.
    """
    try:
        import pandas
        from mobgap.initial_contacts import IcdIonescu
        from mobgap.laterality import LrcUllrich
    except ImportError:
        return None
    columns = ["acc_is", "acc_ml", "acc_pa", "gyr_is", "gyr_ml", "gyr_pa"]
    scaled = samples * np.repeat([9.81, 1.0], 3)
    times: dict[Side, list[float]] = {side: [] for side in Side}
    for start_s, end_s in bouts_s:
        first = max(0, round(start_s * rate_hz))
        data = pandas.DataFrame(scaled[first : round(end_s * rate_hz) + 1], columns=columns)
        contacts = IcdIonescu().detect(data, sampling_rate_hz=rate_hz).ic_list_
        sided = LrcUllrich().predict(data, contacts, sampling_rate_hz=rate_hz).ic_lr_list_
        for sample, side in zip(sided["ic"], sided["lr_label"], strict=True):
            times[Side(str(side))].append((first + float(sample)) / rate_hz)
    return {side: np.sort(np.array(found)) for side, found in times.items()}
