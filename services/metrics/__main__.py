"""`python -m services.metrics`."""

import sys

from services.bus.runner import run_node_service
from services.metrics.node import build

if __name__ == "__main__":
    sys.exit(run_node_service("metrics", build))
