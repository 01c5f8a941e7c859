"""`ambula audit`: the record of who read or changed what, of whoever has the database itself."""

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from services.cli.console import err, out, told

if TYPE_CHECKING:
    from sqlalchemy.orm import Session

    from services.gateway.database import Database

audit = typer.Typer(no_args_is_help=True, help="The record of who read or changed what: verify it, take it away.")


class NoAudit(FileNotFoundError):
    """There is no database where the settings say."""


@audit.command()
def verify() -> None:
    """Walk the whole chain and compare it with the heads that were signed. Exit code 1 where it is not as it was."""
    from services.gateway.access.scope import EVERYTHING
    from services.gateway.audit.heads import Heads, HeadsUnusable
    from services.gateway.audit.verification import verify as walk
    from services.gateway.database import DatabaseError
    from services.gateway.settings import GatewaySettings

    settings = GatewaySettings()
    with told(DatabaseError, NoAudit, HeadsUnusable):
        heads = Heads(settings.own_dir).read()
        with _opened(settings.database_url) as database, database.transaction(EVERYTHING) as session:
            verdict = walk(session, heads)
    if verdict.broken is not None:
        err.print(f"[red]Error:[/red] entry {verdict.broken}: {verdict.fault}", highlight=False)
        err.print("Compare it with a backup, and find out who could write the database.", highlight=False)
        raise typer.Exit(1)
    signed = "none of them signed yet" if verdict.signed is None else f"signed up to entry {verdict.signed.number}"
    out.print(f"the audit is whole: {verdict.entries} entries, {signed}", highlight=False)


@audit.command()
def export(
    file: Annotated[Path, typer.Option("--out", help="file to write; refused when it is there")],
    form: Annotated[str, typer.Option("--format", help="ndjson, or fhir for a Bundle of R4 AuditEvents")] = "ndjson",
) -> None:
    """Write all entries, of every clinic, with the signed heads behind them."""
    from services.gateway.access.scope import EVERYTHING
    from services.gateway.audit.export import as_fhir, as_ndjson
    from services.gateway.audit.heads import Heads, HeadsUnusable
    from services.gateway.database import DatabaseError
    from services.gateway.settings import GatewaySettings

    settings = GatewaySettings()
    with told(DatabaseError, NoAudit, HeadsUnusable, OSError, ValueError):
        if form not in ("ndjson", "fhir"):
            raise ValueError(f"--format takes ndjson or fhir, not {form!r}")
        heads = Heads(settings.own_dir).read()
        with _opened(settings.database_url) as database, file.open("xb") as opened:

            def everything() -> AbstractContextManager["Session"]:
                return database.transaction(EVERYTHING)

            opened.writelines(as_fhir(everything, []) if form == "fhir" else as_ndjson(everything, [], heads))
    out.print(f"written: {file}", highlight=False)


@contextmanager
def _opened(url: str) -> "Iterator[Database]":
    from services.gateway.database import open_database

    file = Path(url.removeprefix("sqlite:///"))
    if url.startswith("sqlite:") and not file.exists():
        raise NoAudit("there is no database yet; set AMBULA_DATA_DIR or AMBULA_DATABASE as for the services")
    database = open_database(url)
    try:
        yield database
    finally:
        database.close()
