"""The node of a session, by what is worn and by the estimator that was chosen."""

from schemas.session import SessionDescription
from schemas.vocabulary import KNEE_ESTIMATORS
from services.estimation.knee.node import KneeNode
from services.estimation.lower_body.node import LowerBodyNode
from services.flow.node import Node


def build(description: SessionDescription) -> Node:
    """The node of one session with default parameters."""
    if description.estimator in KNEE_ESTIMATORS:
        return KneeNode(description)
    return LowerBodyNode(description)
