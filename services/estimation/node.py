"""The node of a session, by what is worn and by the estimator that was chosen."""

from schemas.session import SessionDescription
from services.estimation.lower_body.node import LowerBodyNode
from services.flow.node import Node


def build(description: SessionDescription) -> Node:
    """The node of one session with default parameters."""
    return LowerBodyNode(description)
