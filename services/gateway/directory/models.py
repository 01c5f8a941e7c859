"""What the API takes and gives of names."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

Line = StringConstraints(strip_whitespace=True, pattern=r"^[^\x00-\x1f\x7f]*$")
PersonName = Annotated[str, Line, Field(min_length=1, max_length=120, examples=["Erika Mustermann"])]
RecordNumber = Annotated[str, Line, Field(min_length=1, max_length=40, examples=["4711-2026"])]
MOST_CODES = 200


class NameIn(BaseModel):
    """Who a patient is."""

    model_config = ConfigDict(extra="forbid")

    name: PersonName
    record_number: RecordNumber | None = Field(default=None, description="as the clinic's own records have it")


class NameOut(BaseModel):
    """Who a patient is. Never stored by a browser, never in an address."""

    model_config = ConfigDict(extra="forbid")

    code: str = Field(description="patient code", examples=["K7QM3F"])
    name: str = Field(examples=["Erika Mustermann"])
    record_number: str | None = Field(description="as the clinic's own records have it", examples=["4711-2026"])


class SearchIn(BaseModel):
    """Whom to look for."""

    model_config = ConfigDict(extra="forbid")

    text: str = Field(min_length=2, max_length=100, description="words of name or record number", examples=["erika"])


class CodesIn(BaseModel):
    """Whose names are asked for."""

    model_config = ConfigDict(extra="forbid")

    codes: list[Annotated[str, Field(pattern="^[0-9A-Z]{1,16}$")]] = Field(
        max_length=MOST_CODES, description="patient codes", examples=[["K7QM3F"]]
    )


class NamesOut(BaseModel):
    """Patients whose name is known; those without one, or that are not the caller's to see, are left out."""

    model_config = ConfigDict(extra="forbid")

    items: list[NameOut] = Field(description="by name")
    more: bool = Field(description="there are more than are shown; write more of the name")
