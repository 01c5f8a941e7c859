"""A recording folder as a source: columns in vendor units and axes become samples and frames in Ambula's."""

import itertools
from collections.abc import Iterator
from datetime import UTC
from pathlib import Path

import numpy as np

from schemas.health import Rejection
from schemas.session import (
    CameraDescription,
    HubDescription,
    ReferenceChannel,
    SensorDescription,
    SessionDescription,
    StandingInterval,
)
from schemas.signals import IMU, SKELETON
from schemas.vocabulary import Segment
from services.flow.message import Stream
from services.flow.rejections import RejectionCounter
from services.ingest.camera_file import read_camera
from services.ingest.camera_view import camera_view, floor_height_m
from services.ingest.data import find_data
from services.ingest.driver import SourceMessage
from services.ingest.entries import CameraEntry, HubEntry, SensorEntry
from services.ingest.identity import Identity
from services.ingest.manifest import Manifest, load_manifest
from services.ingest.reference import channels_of, read_reference, reference_track
from services.ingest.sensor_file import read_sensor
from services.ingest.tracks import hub_messages, in_order, reference_messages, skeleton_messages


class Recording:
    """A recording read into memory, checked, and replayed in the order of capture."""

    def __init__(self, manifest_path: Path, identity: Identity) -> None:
        """Read everything. Raises a SourceError that names file, line and column."""
        self._manifest = load_manifest(manifest_path)
        self._identity = identity
        self._rejected = RejectionCounter()
        self._folder = find_data(self._manifest.data, manifest_path.resolve().parent)
        raw = [
            [read_sensor(self._folder, self._manifest, sensor, self._rejected) for sensor in hub.sensor]
            for hub in self._manifest.hub
        ]
        seen = [read_camera(self._folder, self._manifest, entry, self._rejected) for entry in self._manifest.camera]
        truth = [
            read_reference(self._folder, self._manifest, entry, self._rejected) for entry in self._manifest.reference
        ]
        times = [track.time_s for track in itertools.chain(*raw)] + [track.time_s for track in seen]
        zero_s = float(min(time_s.min() for time_s in times + [table.time_s for table in truth]))
        self._hubs = [[track.placed(zero_s) for track in tracks] for tracks in raw]
        self._cameras = [track.placed(zero_s) for track in seen]
        self._reference = reference_track(truth, zero_s) if truth else None

    def describe(self) -> SessionDescription:
        """The session as the manifest tells it, with what the operator chose."""
        manifest, identity = self._manifest, self._identity
        started = manifest.started
        if started is not None and started.tzinfo is None:
            started = started.replace(tzinfo=UTC)
        recorded = SessionDescription(
            session=identity.session,
            title=manifest.title,
            started_unix_ns=identity.started_unix_ns if started is None else round(started.timestamp() * 1e9),
            origin="recording",
            protocol=manifest.protocol,
            task=manifest.task,
            walkway_m=manifest.walkway_m,
            conditions=manifest.conditions,
            estimator=manifest.chosen_estimator,
            walk_path=manifest.walk_path,
            hubs=[
                HubDescription(name=hub.name, sensors=[_described(manifest, sensor) for sensor in hub.sensor])
                for hub in manifest.hub
            ],
            cameras=[_described_camera(manifest, entry) for entry in manifest.camera],
            anthropometry=manifest.body.described(),
            standing=[
                StandingInterval(from_ns=round(span.from_s * 1e9), to_ns=round(span.to_s * 1e9))
                for span in manifest.standing
            ],
            reference=[
                ReferenceChannel(name=name, unit=unit)
                for entry in manifest.reference
                for name, unit in channels_of(entry)
            ],
            duration_s=self._last_ns() * 1e-9,
            known_rhythms=[],
        )
        return identity.choices.applied(recorded)

    def messages(self) -> Iterator[SourceMessage]:
        """One message per hub and tick and per frame of a camera, truth beside them."""
        streams = [
            hub_messages(Stream(IMU, hub.name), tracks, round(1e9 / _fastest(self._manifest, hub)))
            for hub, tracks in zip(self._manifest.hub, self._hubs, strict=True)
        ]
        streams += [
            skeleton_messages(Stream(SKELETON, camera.name), track)
            for camera, track in zip(self._manifest.camera, self._cameras, strict=True)
        ]
        if self._reference is not None:
            streams.append(reference_messages(self._reference, round(1e9 / self._manifest.rate_hz)))
        return in_order(streams)

    def rejections(self) -> list[Rejection]:
        """Rows that were left out, by sensor or file."""
        return self._rejected.report()

    def _last_ns(self) -> int:
        sampled = [track.captured_ns for track in itertools.chain(*self._hubs)]
        return max(int(captured_ns[-1]) for captured_ns in sampled + [track.captured_ns for track in self._cameras])


def _fastest(manifest: Manifest, hub: HubEntry) -> float:
    return max(sensor.rate_hz or manifest.rate_hz for sensor in hub.sensor)


def _described(manifest: Manifest, sensor: SensorEntry) -> SensorDescription:
    return SensorDescription(
        name=sensor.name,
        segment=Segment(sensor.segment),
        rate_hz=sensor.rate_hz or manifest.rate_hz,
        outward_axis=_unit(sensor.outward_axis),
        upward_axis=None if sensor.upward_axis is None else _unit(sensor.upward_axis),
        placement=sensor.placement,
        position_in_segment=sensor.position_in_segment,
    )


def _described_camera(manifest: Manifest, entry: CameraEntry) -> CameraDescription:
    return CameraDescription(
        name=entry.name,
        kind=entry.kind,
        rate_hz=entry.rate_hz or manifest.rate_hz,
        joints=list(camera_view(entry).room_joints),
        floor_m=floor_height_m(entry),
    )


def _unit(direction: list[float]) -> list[float]:
    axis = np.array(direction)
    return list((axis / np.linalg.norm(axis)).tolist())
