"""Frames in the room as the message that leaves ingest."""

from collections.abc import Sequence

import numpy as np

from schemas.skeleton import SkeletonBatch
from services.ingest.skeleton.room import RoomFrames
from services.ingest.skeleton.vendors import STATES

_NAMES = [str(state) for state in STATES]


def skeleton_batch(
    captured_ns: Sequence[int], body: Sequence[int | None], people: Sequence[int], frames: RoomFrames
) -> SkeletonBatch:
    """One message of n frames, oldest first; no marks, which are the operator's."""
    tracked = (frames.state > 0) & np.isfinite(frames.position).all(axis=2)
    return SkeletonBatch.model_validate(
        {
            "captured_ns": list(captured_ns),
            "body": list(body),
            "people": list(people),
            "position": [
                [at if known else None for at, known in zip(frame, row, strict=True)]
                for frame, row in zip(frames.position.tolist(), tracked.tolist(), strict=True)
            ],
            "state": [
                [_NAMES[state] if known else _NAMES[0] for state, known in zip(states, row, strict=True)]
                for states, row in zip(frames.state.tolist(), tracked.tolist(), strict=True)
            ],
            "marks": [],
        }
    )
