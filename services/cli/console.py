"""What every command shares: the console and the way an expected error is told."""

from collections.abc import Iterator
from contextlib import contextmanager

import typer
from rich.console import Console

out = Console()
err = Console(stderr=True)


@contextmanager
def told(*errors: type[Exception]) -> Iterator[None]:
    """Expected errors become one red line and exit code 1; anything else is a bug and keeps its traceback."""
    try:
        yield
    except errors as error:
        err.print(f"[red]Error:[/red] {error}", highlight=False)
        raise typer.Exit(1) from error
