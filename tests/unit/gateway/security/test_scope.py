"""Ways around the scope: nothing of another clinic or in the bin may be read or written by any of them."""

from datetime import UTC, datetime

import pytest
from sqlalchemy import delete, exists, func, insert, literal, select, text, union_all, update
from sqlalchemy.orm import aliased, joinedload, lazyload, selectinload

from services.gateway.access import tables as _  # noqa: F401  every table is known to the metadata
from services.gateway.access.scope import EVERYTHING, OF_PATIENTS, OF_SESSIONS, Scope
from services.gateway.access.statements import OutOfScope
from services.gateway.audit import tables as __  # noqa: F401
from services.gateway.database import open_database
from services.gateway.tables import Base, BaselineRow, ClinicRow, MetricsRow, PatientRow, SessionRow, TreatmentRow

NOW = datetime(2026, 3, 2, 9, tzinfo=UTC)
OURS = Scope("main", frozenset({"SHARED"}))


def patient(code: str, clinic: str, deleted: datetime | None = None) -> PatientRow:
    return PatientRow(
        code=code, clinic_id=clinic, deleted=deleted, year_of_birth=None, sex=None, population=None,
        paretic_side=None, created=NOW,
    )  # fmt: skip


def session_of(code: str, clinic: str | None, deleted: datetime | None = None, number: int = 1) -> SessionRow:
    return SessionRow(
        id=f"walk-{code}" if number == 1 else f"walk-{code}-{number}",
        clinic_id=clinic, deleted=deleted, patient_code=code, title="Walk", protocol="walk",
        state="finished", reason=None, created=NOW, started=NOW, ended=NOW, duration_s=60.0, estimator="rhythmic_ekf",
        origin="synthetic", source=None, task=None, walkway_m=None, description=None,
    )  # fmt: skip


def metrics_of(session: str) -> MetricsRow:
    return MetricsRow(session_id=session, final=True, received=NOW, software="1", body={"secret": session})


@pytest.fixture(scope="module")
def database(tmp_path_factory):
    opened = open_database(f"sqlite:///{tmp_path_factory.mktemp('scope')}/scope.sqlite")
    with opened.transaction(EVERYTHING) as rows:
        rows.add(ClinicRow(id="other", name="Other", keep_days=None, created=NOW))
        rows.flush()
        for code, clinic, deleted in (
            ("OURS", "main", None), ("SHARED", "other", None), ("THEIRS", "other", None), ("BINNED", "main", NOW),
        ):  # fmt: skip
            rows.add(patient(code, clinic, deleted))
            rows.flush()
            rows.add(session_of(code, clinic, deleted))
            rows.flush()
            rows.add(metrics_of(f"walk-{code}"))
    yield opened
    opened.close()


@pytest.fixture
def rows(database):
    """A transaction as ours; whatever it wrote is undone."""
    try:
        with database.transaction(OURS) as session:
            yield session
            raise Undone
    except Undone:
        pass


class Undone(Exception):
    pass


other_patient = aliased(PatientRow)
other_session = aliased(SessionRow)
inner = select(PatientRow.code).subquery()
common = select(PatientRow.code).cte("common")

READINGS = {
    "plain": select(PatientRow.code),
    "entity": select(PatientRow).with_only_columns(PatientRow.code),
    "label": select(PatientRow.code.label("code")),
    "alias": select(other_patient.code),
    "alias of a subquery": select(aliased(PatientRow, select(PatientRow).subquery()).code),
    "subquery": select(inner.c.code),
    "common table expression": select(common.c.code),
    "union": union_all(select(PatientRow.code), select(other_patient.code)),
    "join from a session": select(PatientRow.code).join(SessionRow, SessionRow.patient_code == PatientRow.code),
    "join to an alias": select(other_patient.code).join(SessionRow, SessionRow.patient_code == other_patient.code),
    "outer join from a clinic": select(PatientRow.code).select_from(ClinicRow).outerjoin(PatientRow, literal(True)),
    "cross product": select(other_patient.code).select_from(PatientRow).where(PatientRow.code != other_patient.code),
    "session's column": select(SessionRow.patient_code),
    "session's alias": select(other_session.patient_code),
    "scalar subquery": select(select(func.group_concat(PatientRow.code)).scalar_subquery()),
    "exists": select(ClinicRow.id).where(
        exists().where(PatientRow.clinic_id == ClinicRow.id, PatientRow.code == "THEIRS")
    ),
    "exists of an alias": select(ClinicRow.id).where(
        exists().where(other_patient.clinic_id == ClinicRow.id, other_patient.code == "THEIRS")
    ),
    "in": select(ClinicRow.id).where(ClinicRow.id.in_(select(PatientRow.clinic_id).where(PatientRow.code == "THEIRS"))),
    "condition alone": select(ClinicRow.id).where(PatientRow.clinic_id == ClinicRow.id, PatientRow.code == "THEIRS"),
    "distinct and order": select(PatientRow.code).distinct().order_by(PatientRow.code.desc()).limit(10),
    "or true": select(PatientRow.code).where((PatientRow.code == "OURS") | literal(True)),
    "numbers of a session": select(MetricsRow.session_id),
    "alias of numbers": select(aliased(MetricsRow).session_id),
    "union inside": select(union_all(select(PatientRow.code), select(PatientRow.code)).subquery().c.code),
    "union of common table expressions": select(common.c.code).union(select(aliased(common).c.code)),
}  # fmt: skip


@pytest.mark.parametrize("statement", READINGS.values(), ids=READINGS.keys())
def test_no_query_reads_what_is_not_in_scope(rows, statement):
    found = str(rows.execute(statement).all())
    assert "THEIRS" not in found
    assert "BINNED" not in found
    assert "other" not in found.replace("walk-", "")


@pytest.mark.parametrize("statement", READINGS.values(), ids=READINGS.keys())
def test_each_of_those_queries_could_read_it(database, statement):
    with database.transaction(EVERYTHING) as session:
        found = str(session.execute(statement).all())
    assert "THEIRS" in found or "other" in found


def test_counts_are_of_what_is_in_scope(rows):
    assert rows.scalar(select(func.count()).select_from(PatientRow)) == 2
    assert rows.scalar(select(func.count(SessionRow.id))) == 2
    assert rows.scalar(select(func.count()).select_from(select(other_patient).subquery())) == 2
    assert rows.query(PatientRow).count() == 2


@pytest.mark.parametrize(
    ("table", "ours", "theirs"),
    [
        (PatientRow, "OURS", ("THEIRS", "BINNED")),
        (SessionRow, "walk-OURS", ("walk-THEIRS", "walk-BINNED")),
        (MetricsRow, "walk-OURS", ("walk-THEIRS", "walk-BINNED")),
    ],
)
def test_a_row_by_its_key_is_there_only_in_scope(rows, table, ours, theirs):
    assert rows.get(table, ours) is not None
    for key in theirs:
        assert rows.get(table, key) is None
        assert rows.query(table).filter(table.__mapper__.primary_key[0] == key).one_or_none() is None


def test_what_one_transaction_has_loaded_another_scope_does_not_see(database):
    with database.transaction(EVERYTHING) as session:
        theirs = session.get(PatientRow, "THEIRS")
        assert theirs is not None
    with database.transaction(OURS) as session:
        assert session.get(PatientRow, "THEIRS") is None
        session.merge(theirs)
        with pytest.raises(OutOfScope):
            session.flush()
        session.expunge_all()


def test_numbers_come_with_a_session_however_they_are_loaded(rows):
    for how in (selectinload, joinedload):
        statement = select(SessionRow).options(how(SessionRow.metrics)).execution_options(populate_existing=True)
        found = {row.id: row.metrics for row in rows.scalars(statement).unique()}
        assert found.keys() == {"walk-OURS", "walk-SHARED"}
        assert all(metrics is not None for metrics in found.values())


UNSCOPED = {
    "text": text("select code from patient"),
    "text as entities": select(PatientRow).from_statement(text("select * from patient")),
    "bare table": select(PatientRow.__table__.c.code),
    "bare table inside": select(ClinicRow.id).where(ClinicRow.id.in_(select(PatientRow.__table__.c.clinic_id))),
    "bare alias": select(PatientRow.__table__.alias().c.code),
    "count of a bare table": select(func.count()).select_from(PatientRow.__table__),
    "bare column beside": select(ClinicRow.id, PatientRow.__table__.c.code),
    "bare condition": select(ClinicRow.id).where(PatientRow.__table__.c.code == "THEIRS"),
    "text inside": select(ClinicRow.id, text("(select group_concat(code) from patient)")),
    "insert": insert(PatientRow).values(code="NEW", clinic_id="other", created=NOW),
    "insert from": insert(TreatmentRow).from_select(["patient_code"], select(PatientRow.code)),
    "bare update": update(PatientRow.__table__).values(sex="female"),
    "update": update(PatientRow).values(sex="female"),
    "update to another clinic": update(SessionRow).values(clinic_id="other"),
    "delete": delete(PatientRow),
    "delete of numbers": delete(MetricsRow).where(MetricsRow.session_id == "walk-SHARED"),
}


@pytest.mark.parametrize("statement", UNSCOPED.values(), ids=UNSCOPED.keys())
def test_statements_that_could_not_be_narrowed_are_refused(rows, statement):
    with pytest.raises(OutOfScope):
        rows.execute(statement)


NEW = {
    "patient of another clinic": lambda: patient("NEW", "other"),
    "session of theirs": lambda: session_of("THEIRS", "main", number=2),
    "session of one in the bin": lambda: session_of("BINNED", "main", number=2),
    "session for another clinic": lambda: session_of("OURS", "other", number=2),
    "numbers of theirs": lambda: MetricsRow(session_id="walk-THEIRS", final=True, received=NOW, software="2", body={}),
    "baseline of theirs": lambda: BaselineRow(patient_code="THEIRS", session_id="walk-OURS", frozen=NOW, body={}),
    "their session as baseline": lambda: BaselineRow(
        patient_code="OURS", session_id="walk-THEIRS", frozen=NOW, body={}
    ),
    "treatment of theirs": lambda: TreatmentRow(patient_code="THEIRS", on=NOW.date(), what="botulinum_toxin"),
}


@pytest.mark.parametrize("make", NEW.values(), ids=NEW.keys())
def test_nothing_new_is_written_about_somebody_out_of_scope(rows, make):
    rows.add(make())
    with pytest.raises(OutOfScope):
        rows.flush()


CHANGES = {
    "shared patient corrected": (PatientRow, "SHARED", {"sex": "male"}),
    "shared patient taken over": (PatientRow, "SHARED", {"clinic_id": "main"}),
    "shared patient thrown away": (PatientRow, "SHARED", {"deleted": NOW}),
    "own patient given away": (PatientRow, "OURS", {"clinic_id": "other"}),
    "shared session taken over": (SessionRow, "walk-SHARED", {"clinic_id": "main", "patient_code": "OURS"}),
    "shared session unlinked": (SessionRow, "walk-SHARED", {"patient_code": None}),
    "shared session thrown away": (SessionRow, "walk-SHARED", {"deleted": NOW}),
    "own session linked to theirs": (SessionRow, "walk-OURS", {"patient_code": "THEIRS"}),
    "own session given away": (SessionRow, "walk-OURS", {"clinic_id": "other"}),
}


@pytest.mark.parametrize(("table", "key", "change"), CHANGES.values(), ids=CHANGES.keys())
def test_what_is_another_clinics_is_not_changed_and_ours_not_given_away(rows, table, key, change):
    row = rows.get_one(table, key)
    for name, value in change.items():
        setattr(row, name, value)
    with pytest.raises(OutOfScope):
        rows.flush()


@pytest.mark.parametrize(("table", "key"), [(PatientRow, "SHARED"), (SessionRow, "walk-SHARED")])
def test_what_is_another_clinics_is_not_removed(rows, table, key):
    rows.delete(rows.get_one(table, key))
    with pytest.raises(OutOfScope):
        rows.flush()


def test_our_session_may_be_of_a_shared_patient(rows):
    row = rows.get_one(SessionRow, "walk-OURS")
    row.patient_code, row.clinic_id = "SHARED", "other"
    rows.add(session_of("OURS", None, number=2))
    rows.flush()
    assert rows.get_one(SessionRow, "walk-OURS-2").clinic_id == "main"


def test_the_bin_shows_only_what_was_thrown_away(database):
    with database.transaction(Scope("main", in_bin=True)) as session:
        assert session.scalars(select(PatientRow.code)).all() == ["BINNED"]
        assert session.scalars(select(MetricsRow.session_id)).all() == ["walk-BINNED"]


def test_every_table_about_a_patient_or_a_session_is_narrowed():
    narrowed = {PatientRow, SessionRow, *OF_SESSIONS, *OF_PATIENTS}
    apart = {"patient_share": "asked for by account", "audit_entry": "kept after erasure, read by administrators"}
    for mapper in Base.registry.mappers:
        about = {"patient_code", "session_id", "patient", "session"} & {column.key for column in mapper.columns}
        refers = {key.column.table.name for key in mapper.local_table.foreign_keys} & {"patient", "session"}
        if about or refers:
            assert mapper.class_ in narrowed or mapper.local_table.name in apart, mapper.local_table.name


def test_what_hangs_on_a_row_is_narrowed_however_it_is_loaded(database):
    with database.transaction(EVERYTHING) as session:
        session.get_one(SessionRow, "walk-OURS").patient_code = "BINNED"
    try:
        for how in (selectinload, joinedload, lazyload):
            with database.transaction(OURS) as session:
                statement = select(SessionRow).where(SessionRow.id == "walk-OURS").options(how(SessionRow.patient))
                row = session.scalars(statement).unique().one()
                assert row.patient is None, how
    finally:
        with database.transaction(EVERYTHING) as session:
            session.get_one(SessionRow, "walk-OURS").patient_code = "OURS"
