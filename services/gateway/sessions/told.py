"""How a session was done, as far as anybody said so: at its start, or of its patient since."""

from schemas.conditions import Conditions
from schemas.session import SessionDescription
from services.gateway.patients.records import with_known_side
from services.gateway.tables import SessionRow


def conditions_of(row: SessionRow) -> Conditions | None:
    """Conditions with the paretic side of the patient to whom the session was linked later, unless they name one
    themselves. None before the start."""
    if row.description is None:
        return None
    said = Conditions.model_validate(row.description["conditions"])
    return said if row.patient is None else with_known_side(said, row.patient)


def description_of(row: SessionRow) -> SessionDescription | None:
    """The description with these conditions. None before the start."""
    if row.description is None:
        return None
    description = SessionDescription.model_validate(row.description)
    return description.model_copy(update={"conditions": conditions_of(row)})
