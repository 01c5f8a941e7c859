"""What is wrong with a reference set."""


class ReferenceSetError(ValueError):
    """A folder is no reference set; says which file, where in it, and what to do."""

    def __init__(self, folder: str, where: str, what: str) -> None:
        super().__init__(f"{folder}: {where}: {what}")
        self.folder = folder
        self.where = where
        self.what = what
