"""The two commands."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, DownloadColumn, Progress, TextColumn, TimeRemainingColumn

from services.cli.console import err, out, told

Folder = Annotated[Path, typer.Argument(help="folder of the backup, on another disk; the same one each time")]


def backup(
    folder: Folder,
    names: Annotated[
        bool, typer.Option("--names", help="also the directory of names and its key: then keep the folder like a key")
    ] = False,
) -> None:
    """Copy databases and closed recordings of this site into a folder, while services run; only what is new."""
    from services.cli.backup.contents import BackupError
    from services.cli.backup.making import make_backup
    from services.gateway.database import DatabaseError
    from services.gateway.settings import GatewaySettings

    with told(BackupError, DatabaseError, OSError), _bar() as tell:
        made = make_backup(folder, GatewaySettings(), names=names, tell=tell)
    sessions = len({Path(file.path).parent for file in made.contents.of("recordings")})
    out.print(f"backed up: {sessions} sessions, {made.copied_bytes / 1e6:.1f} MB of recordings are new, in {folder}")
    if made.forgotten:
        out.print(f"erased from the backup, as here: {len(made.forgotten)} sessions")


def restore(
    folder: Folder,
    replace: Annotated[
        bool, typer.Option("--replace", help="move aside what is there; without it, only an empty place is taken")
    ] = False,
    erasures: Annotated[
        Path | None, typer.Option(help="a newer erasures.jsonl than the backup's, kept elsewhere")
    ] = None,
) -> None:
    """Put a backup back: checked first, no service may run, and whoever was erased since is erased again."""
    from services.bus.settings import BusSettings
    from services.cli.backup.contents import BackupError
    from services.cli.backup.restoring import add_erasures
    from services.cli.backup.restoring import restore as put_back
    from services.cli.backup.running import running_services
    from services.cli.erasures import apply_erasures
    from services.gateway.database import DatabaseError
    from services.gateway.erasure.tombstones import FILE as ERASURES
    from services.gateway.erasure.tombstones import TombstonesUnreadable
    from services.gateway.settings import GatewaySettings

    settings = GatewaySettings()
    with told(BackupError, DatabaseError, TombstonesUnreadable, OSError):
        running = running_services(settings, BusSettings())
        if running:
            raise BackupError(f"still running: {', '.join(running)}. Stop the services first, then restore")
        newer = [] if erasures is None else erasures.read_text(encoding="utf-8").splitlines()
        with _bar() as tell:
            aside = put_back(folder, settings, replace=replace, tell=tell)
        add_erasures(settings.own_dir / ERASURES, newer)
        erased = apply_erasures(settings)
    out.print(f"restored from {folder}; erased again: {erased}. Now: ambula doctor --deep, then start the services")
    if aside is not None:
        out.print(f"what was there lies in {aside}; remove it once all is well")


@contextmanager
def _bar() -> Iterator[Callable[[str, int, int], None]]:
    columns = (TextColumn("{task.description}"), BarColumn(), DownloadColumn(), TimeRemainingColumn())
    with Progress(*columns, console=err, transient=True) as progress:
        task = progress.add_task("reading", total=None)

        def tell(what: str, done: int, total: int) -> None:
            progress.update(task, description=what, completed=done, total=max(total, 1))

        yield tell
