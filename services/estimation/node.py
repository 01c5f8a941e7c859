"""The node of a session, by what measures and by the estimator that was chosen."""

from schemas.session import SessionDescription
from schemas.vocabulary import CAMERA_ESTIMATORS, FUSION_ESTIMATORS, KNEE_ESTIMATORS, LOWER_BODY_ESTIMATORS
from services.estimation.body.node import BodyNode
from services.estimation.fusion.node import FusionNode
from services.estimation.knee.node import KneeNode
from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.refusal import RefusingNode
from services.flow.node import Node

NEEDS_BOTH = "fusion needs worn sensors and a camera, and this session has only one of them: choose {choice}"
ONLY_A_CAMERA = "{estimator} needs worn sensors, and this session has only a camera: choose {choice}"


def build(description: SessionDescription) -> Node:
    """The node of one session with default parameters.

    A knee estimator takes every leg with a thigh and a shank sensor, one of the camera the first depth camera; where
    there is none, or the estimator cannot work with it, the session runs, says so on its page and estimates nothing.
    The other estimators take whatever is worn as a lower body.
    """
    try:
        return _chosen(description)
    except ValueError as error:
        return RefusingNode(description, sentence(str(error)))


def _chosen(description: SessionDescription) -> Node:
    """Raises ValueError where the estimator cannot work with what measures, with a reason."""
    estimator = description.estimator
    if estimator in FUSION_ESTIMATORS:
        if description.cameras and description.hubs:
            return FusionNode(description)
        others = CAMERA_ESTIMATORS if description.cameras else LOWER_BODY_ESTIMATORS
        raise ValueError(NEEDS_BOTH.format(choice=" or ".join(others)))
    if estimator in CAMERA_ESTIMATORS:
        return BodyNode(description)
    if description.cameras and not description.hubs:
        raise ValueError(ONLY_A_CAMERA.format(estimator=estimator, choice=next(iter(CAMERA_ESTIMATORS))))
    return KneeNode(description) if estimator in KNEE_ESTIMATORS else LowerBodyNode(description)


def sentence(words: str) -> str:
    """With a capital letter."""
    return words[:1].upper() + words[1:]
