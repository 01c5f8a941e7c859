"""Datagrams of a made-up capture PC."""

import json

import numpy as np

from services.ingest.capture.datagram import decode_frame
from services.ingest.skeleton.vendors import VENDORS
from tests.unit.ingest.capture.two_people import JOINTS, figure


def joints(kind="kinect_v2", height=1.7, x=-2.5, y=-0.1, z=0.0, state=2):
    """A standing person at (x, y, z) of the room, as the camera's SDK tells it; joints outside the 15 not tracked."""
    vendor = VENDORS[kind]
    places = dict(zip(JOINTS, figure(height) + np.array([x, y, z]), strict=True))
    rows = []
    for joint in vendor.joints:
        if joint in places:
            right = places[joint]
            ours = {"kinect_v2": (right[2], right[1], -right[0]), "azure_kinect": (-right[2], -right[1], -right[0])}
            scale = 1.0 if kind == "kinect_v2" else 1000.0
            rows.append([*(float(scale * value) for value in ours[kind]), state])
        else:
            rows.append([0.0, 0.0, 0.0, 0])
    return rows


def frame(seq, *, kind="kinect_v2", t_us=None, bodies=None, **more):
    body = {"id": 7, "joints": joints(kind)}
    return {
        "camera": kind,
        "t_us": 5_000_000 + 33_333 * seq if t_us is None else t_us,
        "seq": seq,
        "bodies": [body] if bodies is None else bodies,
        **more,
    }


def datagram(seq, **more):
    return json.dumps(frame(seq, **more)).encode()


def decoded_frames(count, kind="kinect_v2", **more):
    """So many frames of one person, as they are decoded."""
    return [decode_frame(datagram(seq, kind=kind, **more)) for seq in range(count)]
