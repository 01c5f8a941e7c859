"""Tunables of the gateway that are not a matter of deployment."""

from dataclasses import dataclass


@dataclass(frozen=True)
class GatewayParameters:
    """Defaults from the design's section 8 and the measured fan-out behind it."""

    pose_interval_s: float = 0.03
    """s between two skeletons on a screen at least. They come 25 times a second and are passed on at once; only where
    they come in heaps does this hold some back, whose angles come with the next."""

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

    most_viewers_of_clinic: int = 50
    """Number of them that one clinic may have, so that none can take all."""

    stale_s: float = 3.0
    """s without a health message after which a service counts as silent: three missed ones."""

    final_metrics_grace_s: float = 10.0
    """s that a session which is gone may take to deliver its final metrics before it counts as interrupted."""

    most_body_bytes: int = 1_000_000
    """Bytes of a request body."""

    body_within_s: float = 20.0
    """s in which a request body has to come."""

    requests_per_caller_per_s: float = 100.0
    """Requests of one sign-in or key in the long run; a page that is left open asks about twice a second."""

    request_burst_of_caller: float = 500.0
    """Requests of one sign-in or key at once."""

    requests_per_address_per_s: float = 300.0
    """Requests from one address in the long run: a clinic behind one router."""

    request_burst_of_address: float = 1500.0
    """Requests from one address at once."""

    sign_ins_per_address_per_s: float = 1.0
    """Passwords and codes that are tried from one address in the long run; each account closes much earlier."""

    sign_in_burst_of_address: float = 60.0
    """Passwords and codes from one address at once: everybody begins work at eight."""

    most_socket_bytes: int = 8_192
    """Bytes of one message that a browser may send over a live connection."""

    sign_in_idle_s: float = 3600.0
    """s without any request after which a sign-in ends; an open page asks now and then, so this is a closed one."""

    sign_in_most_s: float = 12 * 3600.0
    """s after which everybody signs in again: a working day."""

    ask_again_s: float = 15.0
    """s after which an open live connection asks again whether its sign-in still holds, and for whom."""

    renewal_grace_s: float = 60.0
    """s in which the secret before the last one is still taken: requests that were under way."""

    confirmed_s: float = 300.0
    """s for which a password that was asked for again counts: erasing, merging."""

    free_failures: int = 5
    """Number of wrong passwords that cost nothing but their time."""

    first_lock_s: float = 30.0
    """s that an account is closed after the next one; doubles each time."""

    longest_lock_s: float = 3600.0
    """s that an account is closed at most, so that nobody can be shut out for good."""

    most_names_searched: int = 20_000
    """Number of the newest patients whose names a search looks through: opening one takes 15 us."""

    bin_days: int = 30
    """Days that what was deleted can be brought back."""
