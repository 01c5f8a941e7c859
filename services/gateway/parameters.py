"""Tunables of the gateway that are not a matter of deployment."""

from dataclasses import dataclass


@dataclass(frozen=True)
class GatewayParameters:
    """Defaults from the design's section 8 and the measured fan-out behind it."""

    pose_interval_s: float = 0.05
    """s between two skeletons on a screen: 20 Hz, enough for the eye and cheap to encode once per session."""

    trail: int = 32
    """Number of skeletons kept per session, so that curves miss none between two that are shown."""

    floor_interval_s: float = 0.5
    """s between two lists of the running sessions; a lost sensor must show within 1 s."""

    heartbeat_s: float = 0.5
    """s after which a viewer without a new skeleton is told how old the last one is."""

    stall_s: float = 5.0
    """s that one send to a browser may take; then that browser is dropped."""

    event_queue: int = 256
    """Number of events that may wait for one browser: about two minutes of walking."""

    most_viewers: int = 100
    """Number of open live connections; 100 of them cost 7 % of a core."""

    stale_s: float = 3.0
    """s without a health message after which a service counts as silent: three missed ones."""

    final_metrics_grace_s: float = 10.0
    """s that a session which is gone may take to deliver its final metrics before it counts as interrupted."""

    most_body_bytes: int = 1_000_000
    """Bytes of a request body."""

    most_socket_bytes: int = 8_192
    """Bytes of one message that a browser may send over a live connection."""
