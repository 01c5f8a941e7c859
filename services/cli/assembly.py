"""The chain of one session put together in this process: what `ambula run`, reprocessing and benchmarks share."""

from schemas.session import SessionDescription
from services.estimation.node import build as build_estimation
from services.flow.chain import Chain
from services.flow.host import HostedNode
from services.flow.node import NodeFactory
from services.metrics.node import build as build_metrics
from services.segmentation.node import build as build_segmentation

NODES: dict[str, NodeFactory] = {
    "estimation": build_estimation,
    "segmentation": build_segmentation,
    "metrics": build_metrics,
}
"""The pure nodes in the order in which data passes them."""


def build_chain(description: SessionDescription) -> Chain:
    """The nodes that would run live for this session, in a plain loop."""
    return Chain([HostedNode(name, description.session, build(description)) for name, build in NODES.items()])
