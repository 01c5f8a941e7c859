"""The archive as a process: one per data folder, waiting for the router when it is not there yet."""

import logging

from services.archive.lock import DataFolderLock, DataFolderUnusable
from services.archive.service import Archive
from services.archive.settings import ArchiveSettings
from services.bus.connection import Bus
from services.bus.lifetime import stop_event
from services.bus.logs import event, set_up_logging
from services.bus.settings import BusSettings
from services.flow.software import VERSION


def run() -> int:
    """Wait for the router, then work until told to stop. Exit code."""
    set_up_logging("archive")
    stop = stop_event()
    settings = ArchiveSettings()
    try:
        with DataFolderLock(settings.data_dir):
            bus = Bus.open_when_ready(BusSettings(), "archive", stop)
            if bus is None:
                return 0
            with bus:
                return Archive(bus, settings.data_dir, VERSION, stop).run()
    except DataFolderUnusable as error:
        logging.getLogger("archive").error(event("not_started", reason=error))
        return 1
