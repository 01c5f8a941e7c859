"""REST of the list of patients."""

from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import StringConstraints
from sqlalchemy.orm import Session

from schemas.population import Population, Sex
from schemas.vocabulary import Side
from services.gateway.access.rules import READ
from services.gateway.context import Context, Gateway, Limit, Offset
from services.gateway.problems import documented
from services.gateway.progress.records import stored_baseline
from services.gateway.references.shelf import reference_uses
from services.gateway.roster import records
from services.gateway.roster.models import RosterEntryOut, RosterPage, StandingOut
from services.gateway.roster.records import NEVER, Comings, Wanted
from services.gateway.tables import PatientRow
from services.gateway.visits.records import sessions_of, visits_of
from services.progress.progress import Person, ReferenceUse, progress

router = APIRouter(prefix="/v1/roster", tags=["patients"])

PartOfCode = Annotated[str, StringConstraints(pattern="^[0-9A-Za-z]{1,16}$")]
CodeWanted = Annotated[str, StringConstraints(pattern="^[0-9A-Z]{1,16}$")]


@router.get("", dependencies=READ, responses=documented())
def list_roster(
    gateway: Context,
    search: Annotated[PartOfCode | None, Query(description="part of the code", examples=["K7"])] = None,
    population: Annotated[Population | None, Query(description="only this group")] = None,
    code: Annotated[
        list[CodeWanted] | None, Query(max_length=100, description="only these codes; may be repeated")
    ] = None,
    offset: Offset = 0,
    limit: Limit = 25,
) -> RosterPage:
    """List the patients with their visits and how they stand against their baseline, who came last first."""
    wanted = Wanted(None if search is None else search.upper(), population, code)
    uses = reference_uses(gateway)
    with gateway.transaction() as database:
        total, rows = records.list_wanted(database, wanted, offset, limit)
        came = records.comings(database, [row.code for row in rows])
        items = [_entry(database, gateway, row, came.get(row.code, NEVER), uses) for row in rows]
        return RosterPage(total=total, items=items)


def _entry(
    database: Session, gateway: Gateway, row: PatientRow, came: Comings, uses: dict[str, ReferenceUse]
) -> RosterEntryOut:
    return RosterEntryOut(
        code=row.code,
        year_of_birth=row.year_of_birth,
        sex=None if row.sex is None else Sex(row.sex),
        population=None if row.population is None else Population(row.population),
        paretic_side=None if row.paretic_side is None else Side(row.paretic_side),
        registered=row.created,
        shared=row.clinic_id != gateway.known_caller.clinic,
        visits=came.visits,
        sessions=came.sessions,
        last_visit=came.last,
        standing=_standing(database, row, uses) if came.visits > 1 else None,
    )


def _standing(database: Session, row: PatientRow, uses: dict[str, ReferenceUse]) -> StandingOut | None:
    """Of the test done last, by its first measure. A list freezes no baseline: where none was, nothing is said."""
    baseline = stored_baseline(database, row.code)
    if baseline is None:
        return None
    visits = visits_of(sessions_of(database, row.code))
    person = Person(
        None if row.population is None else Population(row.population),
        None if row.paretic_side is None else Side(row.paretic_side),
        uses,
    )
    found = [each for each in progress(visits, baseline, person).series if each.points]
    if not found:
        return None
    newest = max(found, key=lambda each: each.points[-1].visit)
    return StandingOut(
        task=newest.task,
        instruction=newest.instruction,
        measure=newest.measure,
        verdict=newest.verdict,
        direction=newest.direction,
    )
