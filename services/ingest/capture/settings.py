"""Where capture PCs may send to, and who may. Read from the environment, `AMBULA_*`."""

from ipaddress import IPv4Network, IPv6Network, ip_address
from typing import Annotated

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict

DEFAULT_PORT = 7788


class CaptureSettings(BaseSettings):
    """Deployment of the ports for capture PCs."""

    model_config = SettingsConfigDict(env_prefix="AMBULA_", extra="ignore", frozen=True)

    skeleton_host: str = Field(
        default="127.0.0.1", description="address to listen on; that of the clinic's network to hear other computers"
    )
    skeleton_ports: list[Annotated[int, Field(ge=1, le=65535)]] = Field(
        default=[DEFAULT_PORT],
        max_length=16,
        description="one per camera, e.g. [7788, 7789]; [] listens only on demand",
    )
    skeleton_senders: list[IPv4Network | IPv6Network] = Field(
        default=[], max_length=64, description='who may send, e.g. ["192.168.7.20", "10.0.3.0/24"]; [] is anybody'
    )

    @property
    def are_ports_chosen(self) -> bool:
        """Somebody said which ports there are, so they are shown even while nothing arrives."""
        return "skeleton_ports" in self.model_fields_set

    def may_send(self, address: str) -> bool:
        """Whether a computer's datagrams are looked at."""
        if not self.skeleton_senders:
            return True
        sender = ip_address(address.partition("%")[0])
        return any(sender in network for network in self.skeleton_senders)

    @property
    def is_open_to_all(self) -> bool:
        """Any computer that reaches the address may send."""
        return not self.skeleton_senders and not self.skeleton_host.startswith("127.") and self.skeleton_host != "::1"
