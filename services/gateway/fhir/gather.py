"""What a FHIR bundle is made from, out of database, archive and report."""

from http import HTTPStatus

from schemas.population import Sex
from services.exports.fhir.source import FhirSource, PrintedReport, Recorded, Subject
from services.gateway.context import Gateway
from services.gateway.problems import Problem
from services.gateway.report.gather import recording_digest, report_source
from services.gateway.report.printing import printed
from services.gateway.sessions.records import get_session
from services.gateway.sessions.shapes import stored_metrics
from services.gateway.sessions.told import description_of
from services.gateway.tables import PatientRow
from services.report.assemble import make_report
from services.report.content import Language


def fhir_source(gateway: Gateway, session: str, site: str, language: Language | None) -> FhirSource:
    """`site` is the address of this gateway, for the link; `language` of the PDF, None for no PDF.

    A session that still runs has no PDF. Raises a 404 problem for an unknown session, a 409 problem for one without
    metrics.
    """
    with gateway.transaction() as database:
        row = get_session(database, session)
        metrics = stored_metrics(row)
        description = description_of(row)
        if metrics is None or description is None:
            step = f"Walk a few steps and read again, or compute it anew with `ambula reprocess {session} --store`."
            raise Problem(HTTPStatus.CONFLICT, f"Session {session} has no metrics.", step)
        patient = None if row.patient_code is None else database.get(PatientRow, row.patient_code)
        subject = None if patient is None else _subject(patient)
        began = row.started or row.created
    return FhirSource(
        description=description,
        metrics=metrics,
        began=began,
        subject=subject,
        report=None if language is None or not metrics.final else _printed(gateway, session, language),
        recording=_recorded(gateway, session, site),
    )


def _subject(row: PatientRow) -> Subject:
    return Subject(row.code, row.year_of_birth, None if row.sex is None else Sex(row.sex))


def _printed(gateway: Gateway, session: str, language: Language) -> PrintedReport:
    report = make_report(report_source(gateway, session), language)
    return PrintedReport(printed(report), language)


def _recorded(gateway: Gateway, session: str, site: str) -> Recorded:
    digest = recording_digest(gateway.settings.data_dir, session)
    return Recorded(f"{site.rstrip('/')}/v1/sessions/{session}/recordings", digest)
