"""Run the estimation service."""

import sys

from services.bus.runner import run_node_service
from services.estimation.lower_body.warm_up import warm_up
from services.estimation.node import build

if __name__ == "__main__":
    warm_up()
    sys.exit(run_node_service("estimation", build))
