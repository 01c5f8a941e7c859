"""`python -m services.segmentation`."""

import sys

from services.bus.runner import run_node_service
from services.segmentation.node import build
from services.segmentation.warm_up import warm_up

if __name__ == "__main__":
    sys.exit(run_node_service("segmentation", build, (warm_up,)))
