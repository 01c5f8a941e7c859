"""`python -m services.archive`: records every session of the site."""

import sys

from services.archive.process import run

if __name__ == "__main__":
    sys.exit(run())
