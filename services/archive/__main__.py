"""`python -m services.archive`: records every session of the site."""

import sys
from importlib.metadata import version

from services.archive.service import Archive
from services.archive.settings import ArchiveSettings
from services.bus.connection import Bus
from services.bus.lifetime import stop_event
from services.bus.logs import set_up_logging
from services.bus.settings import BusSettings


def main() -> int:
    """Wait for the router, then work until told to stop."""
    set_up_logging("archive")
    stop = stop_event()
    bus = Bus.open_when_ready(BusSettings(), "archive", stop)
    if bus is None:
        return 0
    with bus:
        return Archive(bus, ArchiveSettings().data_dir, version("ambula"), stop).run()


if __name__ == "__main__":
    sys.exit(main())
