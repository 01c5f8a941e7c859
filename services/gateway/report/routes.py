"""REST of reports: content for a page, a page of its own, PDF; and the words they are written in."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Path, Query
from fastapi.responses import HTMLResponse, Response

from services.gateway.context import Context, Gateway, SessionId
from services.gateway.problems import Problem, documented
from services.gateway.report.gather import report_source
from services.report.assemble import make_report
from services.report.catalogue import catalogue
from services.report.content import Language, Report
from services.report.html import page
from services.report.press import press

router = APIRouter(prefix="/v1", tags=["reports"])

PDF = "application/pdf"
In = Annotated[Language, Query(description="language of the report", examples=["fr"])]
LanguageCode = Annotated[str, Path(pattern="^[a-z]{2}$", description="ISO 639 code of a language", examples=["fr"])]
PROBLEMS = documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT)


@router.get("/sessions/{session}/report", responses=PROBLEMS)
def read_report(session: SessionId, gateway: Context, language: In = Language.ENGLISH) -> Report:
    """The report of a session as content: sentences, tables, charts as SVG. Progress is told up to its visit."""
    return _report(gateway, session, language)


@router.get(
    "/sessions/{session}/report.html",
    response_class=HTMLResponse,
    responses={200: {"content": {"text/html": {}}, "description": "The page"}, **PROBLEMS},
)
def read_report_page(session: SessionId, gateway: Context, language: In = Language.ENGLISH) -> HTMLResponse:
    """The report as one page that needs nothing else, and prints on A4."""
    return HTMLResponse(page(_report(gateway, session, language)))


@router.get(
    "/sessions/{session}/report.pdf",
    response_class=Response,
    responses={200: {"content": {PDF: {}}, "description": "The PDF"}, **PROBLEMS},
)
def read_report_pdf(session: SessionId, gateway: Context, language: In = Language.ENGLISH) -> Response:
    """The report as tagged PDF (PDF/UA-1). The same results give the same bytes."""
    report = _report(gateway, session, language)
    name = f'inline; filename="{session}-{language}.pdf"'
    return Response(press().pdf(report), media_type=PDF, headers={"Content-Disposition": name})


@router.get("/wording/{language}", responses=documented(HTTPStatus.NOT_FOUND))
def read_wording(language: LanguageCode) -> dict[str, str]:
    """Every word of the reports by its key: names of metrics, conditions, phases, verdicts, reasons."""
    if language not in list(Language):
        languages = ", ".join(Language)
        detail = f"There are no words in {language}."
        raise Problem(HTTPStatus.NOT_FOUND, detail, f"Reports are written in: {languages}.")
    return catalogue(Language(language)).messages


def _report(gateway: Gateway, session: str, language: Language) -> Report:
    return make_report(report_source(gateway, session), language)
