"""The node of a session, by what is worn and by the estimator that was chosen."""

from schemas.session import SessionDescription
from schemas.vocabulary import KNEE_ESTIMATORS
from services.estimation.knee.node import KneeNode
from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.refusal import RefusingNode
from services.flow.node import Node


def build(description: SessionDescription) -> Node:
    """The node of one session with default parameters.

    A knee estimator takes every leg with a thigh and a shank sensor; where there is none, or the estimator cannot work
    with how they are worn, the session runs, says so on its page and estimates nothing. The other estimators take
    whatever is worn as a lower body.
    """
    if description.estimator not in KNEE_ESTIMATORS:
        return LowerBodyNode(description)
    try:
        return KneeNode(description)
    except ValueError as error:
        return RefusingNode(description, sentence(str(error)))


def sentence(words: str) -> str:
    """With a capital letter."""
    return words[:1].upper() + words[1:]
