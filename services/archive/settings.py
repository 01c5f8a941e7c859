"""What differs between installations. Read from the environment, `AMBULA_*`."""

from pathlib import Path

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict


class ArchiveSettings(BaseSettings):
    """Deployment of the archive."""

    model_config = SettingsConfigDict(env_prefix="AMBULA_", extra="ignore", frozen=True)

    data_dir: Path = Field(default=Path("data"), description="the folder that holds one folder per session")
