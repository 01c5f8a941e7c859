"""The reference sets of this site."""

from services.gateway.context import Gateway
from services.progress.progress import ReferenceUse
from services.reference.folders import Shelf, own_folders, read_shelf
from services.reference.sets import SetKind


def shelf_of(gateway: Gateway) -> Shelf:
    """Read anew each time: a set that a clinic adds is there without a restart."""
    return read_shelf(own_folders(gateway.settings.references))


def reference_uses(gateway: Gateway) -> dict[str, ReferenceUse]:
    """Reference sets as far as like with like goes."""
    return {
        each.manifest.name: ReferenceUse(each.manifest.version, each.measures)
        for each in shelf_of(gateway).sets
        if each.manifest.kind is SetKind.NORMS
    }
