"""Run the estimation service."""

import sys

from services.bus.runner import run_node_service
from services.estimation.body.warm_up import warm_up as warm_up_body
from services.estimation.knee.warm_up import warm_up as warm_up_knee
from services.estimation.lower_body.warm_up import warm_up as warm_up_lower_body
from services.estimation.node import build

if __name__ == "__main__":
    sys.exit(run_node_service("estimation", build, (warm_up_lower_body, warm_up_knee, warm_up_body)))
