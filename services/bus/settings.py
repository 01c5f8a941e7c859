"""Where the router is and which site this is."""

from pydantic_settings import BaseSettings, SettingsConfigDict


class BusSettings(BaseSettings):
    """Deployment settings, from AMBULA_ROUTER and AMBULA_SITE."""

    model_config = SettingsConfigDict(env_prefix="AMBULA_", frozen=True)

    router: str = "tcp/127.0.0.1:7447"
    """Endpoint of the one router, in Zenoh's notation."""
    site: str = "home"
    """First word of every key; access rules follow it."""
