"""After a backup was brought back, while no service runs: who was erased since is erased again, recordings included."""

from schemas.archive_layout import folder_name
from services.archive.disk import Disk
from services.archive.erasing import erase_folder
from services.gateway.bus_control import BusControl
from services.gateway.bus_feed import BusLink
from services.gateway.database import open_database
from services.gateway.directory.store import NameDirectory
from services.gateway.erasure.eraser import Eraser
from services.gateway.erasure.tombstones import Tombstones
from services.gateway.live.hub import LiveHub
from services.gateway.sessions.keeper import SessionKeeper
from services.gateway.settings import GatewaySettings


def apply_erasures(settings: GatewaySettings) -> int:
    """Erase again what the list of erasures names; number of patients, sessions and recordings that had come back.

    Raises TombstonesUnreadable, DatabaseError, OSError.
    """
    stones = Tombstones(settings.own_dir)
    if not stones.read():
        return 0
    database = open_database(settings.database_url)
    directory = NameDirectory(settings.directory_url, settings.directory_key)
    live = LiveHub()
    keeper = SessionKeeper(database, live)
    try:
        eraser = Eraser(database, directory, stones, settings.data_dir, keeper, live, BusControl(BusLink()))
        again = eraser.apply_again()
    finally:
        directory.close()
        database.close()
    return again + _remove_folders(settings, stones)


def _remove_folders(settings: GatewaySettings, stones: Tombstones) -> int:
    named = {session for stone in stones.read() for session in stone.sessions}
    folders = [settings.data_dir / folder_name(session) for session in sorted(named)]
    left = [folder for folder in folders if folder.exists()]
    for folder in left:
        erase_folder(folder, Disk())
    return len(left)
