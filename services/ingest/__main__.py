"""`python -m services.ingest`."""

import sys

from services.ingest.service import run_ingest

if __name__ == "__main__":
    sys.exit(run_ingest())
