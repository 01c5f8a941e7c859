"""Run the estimation service."""

import sys

from services.bus.runner import run_node_service
from services.estimation.node import build

if __name__ == "__main__":
    sys.exit(run_node_service("estimation", build))
