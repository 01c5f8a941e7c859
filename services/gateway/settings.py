"""What differs between installations: addresses and places. Read from the environment, `AMBULA_*`."""

from pathlib import Path
from typing import Self

from pydantic import Field, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict
from sqlalchemy import make_url

from services.gateway.accounts.oidc.settings import OidcProvider, ProviderName

DIST = Path(__file__).parent / "static" / "dist"
"""Where the built pages are."""

LOOPBACK_NAMES = ["127.0.0.1", "localhost", "[::1]"]


class GatewaySettings(BaseSettings):
    """Deployment of one gateway."""

    model_config = SettingsConfigDict(env_prefix="AMBULA_", extra="ignore")

    http_host: str = Field(default="127.0.0.1", description="address to listen on; 0.0.0.0 for every interface")
    http_port: int = Field(default=8000, ge=0, le=65535, description="port to listen on; 0 for any free one")
    http_names: list[str] | None = Field(
        default=None,
        description="host names a browser may use; unset means the loopback names when listening there, else any",
    )
    http_certificate: Path | None = Field(
        default=None, description="certificate chain in PEM format; with it the page is served over TLS alone"
    )
    http_key: Path | None = Field(default=None, description="private key of the certificate, PEM format, not encrypted")
    public_url: str = Field(
        default="",
        pattern=r"^(https?://[^/\s]+)?$",
        description="the address that browsers use, when a proxy stands before the gateway or people sign in elsewhere",
    )
    oidc: dict[ProviderName, OidcProvider] = Field(
        default_factory=dict, description="sign-in services of the organisation (OpenID Connect), by name"
    )
    database: str = Field(default="", description="SQLAlchemy URL; empty for a SQLite file in the data folder")
    database_password_file: Path | None = Field(
        default=None, description="file with the database's password, for a URL without one"
    )
    data_dir: Path = Field(default=Path("data"), description="the folder with the archive's recordings")
    gateway_dir: Path | None = Field(
        default=None,
        description="the gateway's own folder: its keys and the list of erasures; unset means the data folder",
    )
    directory: str = Field(
        default="", description="SQLAlchemy URL of the directory of names; empty for a SQLite file in the own folder"
    )
    directory_key_file: Path | None = Field(
        default=None, description="key of the directory of names; unset means a file in the own folder"
    )
    references: str = Field(
        default="", description="folders of the clinic's own reference sets, as a path list; the shipped ones come last"
    )
    clinic: str = Field(default="main", description="id of the clinic that sessions nobody asked for belong to")
    pages_dir: Path = Field(default=DIST, description="the folder with the built pages")

    @property
    def database_url(self) -> str:
        """The URL to connect to; plain PostgreSQL addresses are given the driver that is installed."""
        if not self.database:
            return f"sqlite:///{self.data_dir / 'ambula.sqlite'}"
        if self.database_password_file is None:
            return _with_driver(self.database)
        password = self.database_password_file.read_text(encoding="utf-8").strip()
        return make_url(_with_driver(self.database)).set(password=password).render_as_string(hide_password=False)

    @property
    def own_dir(self) -> Path:
        """What only the gateway writes: keys, heads of the audit, the list of erasures."""
        return self.gateway_dir or self.data_dir

    @property
    def directory_url(self) -> str:
        """The URL of the directory of names."""
        return _with_driver(self.directory) if self.directory else f"sqlite:///{self.own_dir / 'directory.sqlite'}"

    @property
    def directory_key(self) -> Path:
        """Where the key of the directory lies."""
        return self.directory_key_file or self.own_dir / "directory.key"

    @property
    def is_secure(self) -> bool:
        """Whether the gateway itself speaks TLS."""
        return self.http_certificate is not None

    @model_validator(mode="after")
    def _check_pair(self) -> Self:
        if (self.http_certificate is None) != (self.http_key is None):
            raise ValueError("AMBULA_HTTP_CERTIFICATE and AMBULA_HTTP_KEY belong together: set both or none")
        return self

    @property
    def url(self) -> str:
        """What to open in a browser on this machine."""
        host = "127.0.0.1" if self.http_host in ("0.0.0.0", "::") else self.http_host
        return f"{'https' if self.is_secure else 'http'}://{host}:{self.http_port}"

    @property
    def host_names(self) -> list[str]:
        """Names that a Host header may carry; `*` for any."""
        if self.http_names is not None:
            return self.http_names
        return LOOPBACK_NAMES if self.http_host in ("127.0.0.1", "localhost", "::1") else ["*"]


def _with_driver(url: str) -> str:
    return url.replace("postgresql://", "postgresql+psycopg://", 1)
