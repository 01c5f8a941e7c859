"""What a check says."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """One line of the report. `ok` None: not needed, or not to be told, but worth a look."""

    subject: str
    ok: bool | None
    says: str


MARKS: dict[bool | None, str] = {True: "[green]ok[/green]", False: "[red]fix[/red]", None: "[yellow]note[/yellow]"}
