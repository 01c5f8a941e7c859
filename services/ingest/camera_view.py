"""A camera of a manifest: how it looks into the room, checked before its file is opened."""

from services.ingest.entries import CameraEntry, FormatEntry
from services.ingest.errors import InvalidManifest
from services.ingest.skeleton import CameraView, plane_of_floor, view_of
from services.ingest.timing import check_time


def camera_view(entry: CameraEntry) -> CameraView:
    """Raises WrongAxes, InvalidManifest or UnknownUnit."""
    up = entry.up if entry.floor_plane is None else plane_of_floor(entry.floor_plane)[0]
    return view_of(entry.kind, up=up, joints=entry.joints, axes=entry.axes, unit=entry.unit)


def floor_height_m(entry: CameraEntry) -> float | None:
    """m in the room, negative below the camera; None when the manifest does not say."""
    if entry.floor_plane is not None:
        return plane_of_floor(entry.floor_plane, camera_view(entry).metres)[1]
    return entry.floor_m


def check_camera(entry: CameraEntry, usual_format: FormatEntry, where: str) -> None:
    """Raises a SourceError that says what is wrong with it and what to write."""
    try:
        view = camera_view(entry)
    except ValueError as error:
        raise type(error)(f"{where}: {error}") from error
    if (entry.numbers is None) == (entry.columns is None):
        raise InvalidManifest(f"{where}: write either numbers (joints in order) or columns (joints by name)")
    if entry.numbers is not None and (entry.format or usual_format).header:
        raise InvalidManifest(
            f"{where}: numbers counts columns, which in a file with a header have names: write columns, or "
            "format = { header = false, skip_lines = 1 }"
        )
    if entry.floor_plane is not None and (entry.up is not None or entry.floor_m is not None):
        raise InvalidManifest(f"{where}: floor_plane says where up and the floor are; leave out up and floor_m")
    for joint in view.joints:
        if view.joints.count(joint) > 1:
            raise InvalidManifest(f"{where}: joint {joint} appears twice; each is delivered once")
    if entry.columns is not None and len(entry.columns.names) != len(view.joints):
        raise InvalidManifest(
            f"{where}: {len(entry.columns.names)} names for {len(view.joints)} joints; give them in the camera's order"
        )
    if entry.time is not None:
        check_time(entry.time)
