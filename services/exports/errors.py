"""Why a file cannot be written."""


class ExportError(ValueError):
    """Something about a session, or about what was asked for, rules a format out.

    `field` names the value at fault, `next_step` what to do instead.
    """

    def __init__(self, field: str, what: str, next_step: str) -> None:
        super().__init__(f"{field}: {what}; {next_step}")
        self.field = field
        self.what = what
        self.next_step = next_step
