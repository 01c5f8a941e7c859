"""What the API says of exports."""

from pydantic import BaseModel, ConfigDict, Field


class ExportOut(BaseModel):
    """One format."""

    model_config = ConfigDict(extra="forbid")

    format: str = Field(description="last part of the path to get it", examples=["strides.csv"])
    file_name: str = Field(description="says the session's id only", examples=["ambula-8d0c2a71f04be655-strides.csv"])
    media_type: str = Field(examples=["text/csv; charset=utf-8"])
    about: str = Field(examples=["Table: one row a stride of each foot."])
    available: bool
    reason: str | None = Field(description="why it cannot be had; null when it can", examples=[None])


class ExportsOut(BaseModel):
    """Every format, those that cannot be had too."""

    model_config = ConfigDict(extra="forbid")

    session: str = Field(examples=["8d0c2a71f04be655"])
    software: str | None = Field(
        description="what computed the results in the files; null while there are none",
        examples=["ambula 0.1.0+1f2e3d4c"],
    )
    items: list[ExportOut]
