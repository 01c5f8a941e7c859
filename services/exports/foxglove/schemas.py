"""JSON schemas of the messages.

Those named `foxglove.*` are the viewer's own kinds, which it draws by that name; of each, the fields that we fill. The
others are ours: flat objects, so that every field can be plotted.
"""

from typing import Any

from schemas.gait import Stride
from schemas.vocabulary import BODY_MODELS, DegreeOfFreedom

Schema = dict[str, Any]

NUMBER: Schema = {"type": "number"}
TEXT: Schema = {"type": "string"}


def _object(title: str | None = None, required: tuple[str, ...] | None = None, **properties: Schema) -> Schema:
    names = list(properties) if required is None else list(required)
    about = {} if title is None else {"title": title}
    return {**about, "type": "object", "properties": properties, "required": names}


def _list(items: Schema, **limits: int) -> Schema:
    return {"type": "array", "items": items, **limits}


TIME = _object(sec={"type": "integer", "minimum": 0}, nsec={"type": "integer", "minimum": 0, "maximum": 999_999_999})
VECTOR = _object(x=NUMBER, y=NUMBER, z=NUMBER)
QUATERNION = _object(x=NUMBER, y=NUMBER, z=NUMBER, w=NUMBER)
POSE = _object(position=VECTOR, orientation=QUATERNION)
COLOUR = _object(r=NUMBER, g=NUMBER, b=NUMBER, a=NUMBER)
_NOTHING = _list({"type": "object"}, maxItems=0)

TRANSFORM = _object(timestamp=TIME, parent_frame_id=TEXT, child_frame_id=TEXT, translation=VECTOR, rotation=QUATERNION)
FRAME_TRANSFORMS = _object("foxglove.FrameTransforms", transforms=_list(TRANSFORM))

LINES = _object(
    type={"type": "integer", "enum": [2]},
    pose=POSE,
    thickness=NUMBER,
    scale_invariant={"type": "boolean"},
    points=_list(VECTOR),
    color=COLOUR,
    colors=_list(COLOUR),
    indices=_list({"type": "integer"}),
)
SPHERE = _object(pose=POSE, size=VECTOR, color=COLOUR)
ENTITY = _object(
    timestamp=TIME,
    frame_id=TEXT,
    id=TEXT,
    lifetime=TIME,
    frame_locked={"type": "boolean"},
    metadata=_NOTHING,
    arrows=_NOTHING,
    cubes=_NOTHING,
    spheres=_list(SPHERE),
    cylinders=_NOTHING,
    lines=_list(LINES),
    triangles=_NOTHING,
    texts=_NOTHING,
    models=_NOTHING,
)
SCENE_UPDATE = _object("foxglove.SceneUpdate", deletions=_NOTHING, entities=_list(ENTITY))

LOG = _object(
    "foxglove.Log",
    timestamp=TIME,
    level={"type": "integer", "enum": [1, 2, 3]},
    message=TEXT,
    name=TEXT,
    file=TEXT,
    line={"type": "integer", "minimum": 0},
)

STRIDE_NUMBERS = (
    "stride_time_s", "stance_fraction", "step_time_s", "step_length_m", "stride_length_m", "walking_speed",
    "step_width_m", "circumduction_m", "turn",
)  # fmt: skip
STRIDE = _object(
    "ambula.Stride",
    ("time_s", "side", "valid", "stride_time_s"),
    time_s={**NUMBER, "description": "s since the session started, of the contact that ends the stride"},
    side={**TEXT, "enum": ["left", "right"]},
    valid={"type": "boolean"},
    **{name: {**NUMBER, "description": Stride.model_fields[name].description or ""} for name in STRIDE_NUMBERS},
)


def joint_angles(model: str) -> Schema:
    """Angles of a body model in degrees; one that is not valid at a time is not in the message."""
    fields: Schema = {"time_s": {**NUMBER, "description": "s since the session started"}}
    for freedom in BODY_MODELS[model]:
        fields |= _angle(freedom)
    return _object(f"ambula.JointAngles.{model}", ("time_s",), **fields)


def _angle(freedom: DegreeOfFreedom) -> Schema:
    return {
        f"{freedom.name}_deg": {**NUMBER, "description": f"degrees, positive = {freedom.positive}"},
        f"{freedom.name}_std_deg": {**NUMBER, "description": "degrees, one standard deviation"},
    }
