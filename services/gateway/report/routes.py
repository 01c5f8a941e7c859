"""REST of reports: content for a page, a page of its own, PDF; and the words they are written in."""

from dataclasses import dataclass
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Depends, Path, Query
from fastapi.responses import HTMLResponse, Response

from services.gateway.access.rules import KNOWN, READ
from services.gateway.context import Context, Gateway, SessionId
from services.gateway.problems import Problem, documented
from services.gateway.report.gather import report_source
from services.gateway.report.printing import printed
from services.report.assemble import make_report
from services.report.catalogue import catalogue
from services.report.content import Language, Report
from services.report.html import page

router = APIRouter(prefix="/v1", tags=["reports"])

PDF = "application/pdf"
In = Annotated[Language, Query(description="language of the report", examples=["fr"])]
AllStrides = Annotated[
    bool, Query(description="also every stride, from the recording: why some were left out, and a page of them all")
]
LanguageCode = Annotated[str, Path(pattern="^[a-z]{2}$", description="ISO 639 code of a language", examples=["fr"])]


@dataclass(frozen=True)
class Wish:
    """How a report is asked for."""

    language: In = Language.ENGLISH
    strides: AllStrides = False


Asked = Annotated[Wish, Depends()]
PROBLEMS = documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT)
PRINTING = documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT, HTTPStatus.SERVICE_UNAVAILABLE)


@router.get("/sessions/{session}/report", dependencies=READ, responses=PROBLEMS)
def read_report(session: SessionId, gateway: Context, asked: Asked) -> Report:
    """The report of a session as content: sentences, tables, charts as SVG. Progress is told up to its visit."""
    return _report(gateway, session, asked)


@router.get(
    "/sessions/{session}/report.html",
    dependencies=READ,
    response_class=HTMLResponse,
    responses={200: {"content": {"text/html": {}}, "description": "The page"}, **PROBLEMS},
)
def read_report_page(session: SessionId, gateway: Context, asked: Asked) -> HTMLResponse:
    """The report as one page that needs nothing else, and prints on A4."""
    return HTMLResponse(page(_report(gateway, session, asked)))


@router.get(
    "/sessions/{session}/report.pdf",
    dependencies=READ,
    response_class=Response,
    responses={200: {"content": {PDF: {}}, "description": "The PDF"}, **PRINTING},
)
def read_report_pdf(session: SessionId, gateway: Context, asked: Asked) -> Response:
    """The report as tagged PDF (PDF/UA-1). The same results give the same bytes."""
    report = _report(gateway, session, asked)
    name = f'inline; filename="{session}-{asked.language}.pdf"'
    return Response(printed(report), media_type=PDF, headers={"Content-Disposition": name})


@router.get("/wording/{language}", dependencies=KNOWN, responses=documented(HTTPStatus.NOT_FOUND))
def read_wording(language: LanguageCode) -> dict[str, str]:
    """Every word of the reports by its key: names of metrics, conditions, phases, verdicts, reasons."""
    if language not in list(Language):
        languages = ", ".join(Language)
        detail = f"There are no words in {language}."
        raise Problem(HTTPStatus.NOT_FOUND, detail, f"Reports are written in: {languages}.")
    return catalogue(Language(language)).messages


def _report(gateway: Gateway, session: str, asked: Asked) -> Report:
    return make_report(report_source(gateway, session, with_strides=asked.strides), asked.language)
