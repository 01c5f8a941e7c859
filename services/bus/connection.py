"""The connection of one process to the router: publish, subscribe, ask, serve, tokens."""

# Zenoh's own package is imported here and in router.py only.
import json
import logging
import secrets
import threading
import time
import traceback
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Self

import zenoh
from zenoh import ext, handlers

from services.bus.logs import event
from services.bus.received import Handle, Received
from services.bus.settings import BusSettings

LEASE_MS = 2000
"""A frozen or unplugged peer is noticed after this time; a killed one at once."""
CACHED_MESSAGES = 64
"""Per stream, for the substrate's own recovery of short gaps; longer ones are replayed from the ring."""
HEARTBEAT_S = 0.5
"""After the last message of a burst its number is repeated once, so that a lost last message is noticed."""

PAUSE_S = 0.3
"""Before a question is asked again."""

TIMED_OUT = "Timeout"
"""What the bus itself says in place of a peer whose answer did not come in time."""

logger = logging.getLogger(__name__)


class BusUnavailable(ConnectionError):
    """The router cannot be reached."""


class RemoteError(RuntimeError):
    """The peer answered with an error; the text is the peer's."""


def base_config() -> zenoh.Config:
    """What router and clients have in common: nothing is discovered, silence is noticed, no shared memory."""
    config = zenoh.Config()
    settings: dict[str, Any] = {
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "scouting/delay": 0,
        "transport/link/tx/lease": LEASE_MS,
        "transport/shared_memory/enabled": False,
    }
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return config


def _client_config(endpoint: str, timeout_s: float) -> zenoh.Config:
    config = base_config()
    settings: dict[str, Any] = {
        "mode": "client",
        "listen/endpoints": [],
        "connect/endpoints": [endpoint],
        "connect/timeout_ms": int(timeout_s * 1000),
        "connect/retry": {"period_init_ms": 100, "period_max_ms": 1000, "period_increase_factor": 1.5},
    }
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return config


class Bus:
    """One Zenoh session, client of one router. Callbacks come on Zenoh's threads and must only enqueue.

    What a callback raises is logged, counted in `errors` and goes no further. After a loss of the router the
    connection comes back by itself, with everything that was declared on it.
    """

    def __init__(self, session: zenoh.Session, settings: BusSettings, service: str) -> None:
        self.settings = settings
        self.service = service
        self.instance = secrets.token_hex(4)
        self.errors = 0
        self.extras: dict[str, dict[str, object]] = {}
        """What lives as long as the connection: the ring servers of the signals this process sends."""
        self._session = session
        self._closed = False
        self._declared: set[Handle] = set()

    @classmethod
    def open(cls, settings: BusSettings, service: str, timeout_s: float = 2.0) -> Self:
        """Connect. Raises BusUnavailable when no router answers within `timeout_s`."""
        try:
            session = zenoh.open(_client_config(settings.router, timeout_s))
        except zenoh.ZError as error:
            raise BusUnavailable(
                f"no router at {settings.router}: start one with 'ambula up', or say where it is in AMBULA_ROUTER"
            ) from error
        return cls(session, settings, service)

    @classmethod
    def open_when_ready(cls, settings: BusSettings, service: str, stop: threading.Event) -> Self | None:
        """Connect as soon as there is a router, saying once that it is waited for; None when stopped before."""
        told = False
        while not stop.is_set():
            try:
                return cls.open(settings, service)
            except BusUnavailable as error:
                if not told:
                    logger.warning(event("waiting_for_router", router=settings.router, hint=str(error)))
                told = True
                stop.wait(0.2)
        return None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def connected(self) -> bool:
        """There is a router at the other end."""
        return bool(self._session.info.routers_zid())

    def subscribe(self, key: str, callback: Callable[[Received], None]) -> Handle:
        """Plain subscription, best effort, for live and state signals. One thread each: use wildcards."""
        subscriber = self._session.declare_subscriber(key, self._guarded(callback, _received))
        return self._keep(subscriber.undeclare)

    def subscribe_recovering(self, key: str, callback: Callable[[Received], None]) -> Handle:
        """Subscription that asks publishers' caches for short gaps; order and completeness are the caller's."""
        subscriber = ext.declare_advanced_subscriber(
            self._session,
            key,
            self._guarded(callback, _received),
            recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True),
        )
        return self._keep(subscriber.undeclare)

    def publish_cached(self, key: str) -> tuple[Callable[[bytes, bytes], None], Handle]:
        """A publisher with a cache for `subscribe_recovering`: put(payload, attachment), and its grip."""
        publisher = ext.declare_advanced_publisher(
            self._session,
            key,
            congestion_control=zenoh.CongestionControl.DROP,
            cache=ext.CacheConfig(CACHED_MESSAGES),
            sample_miss_detection=ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=HEARTBEAT_S),
        )

        def put(payload: bytes, attachment: bytes) -> None:
            publisher.put(payload, attachment=attachment)

        return put, self._keep(publisher.undeclare)

    def put(self, key: str, payload: bytes, attachment: bytes = b"") -> None:
        """Send once, dropped rather than waited for when the way is full."""
        self._session.put(key, payload, attachment=attachment or None, congestion_control=zenoh.CongestionControl.DROP)

    def serve(self, key: str, handler: Callable[[str, dict[str, str], bytes], Iterable[Received]]) -> Handle:
        """Answer questions: handler(key, parameters, body) on a thread of its own; what it raises is the answer."""

        def answer(query: zenoh.Query) -> None:
            with query:
                parameters = _parameters(str(query.parameters))
                body = query.payload.to_bytes() if query.payload is not None else b""
                try:
                    for reply in handler(str(query.key_expr), parameters, body):
                        query.reply(reply.key, reply.payload, attachment=reply.attachment or None)
                except Exception as error:  # noqa: BLE001 - whatever it is, the peer is told
                    self._count_error(key)
                    query.reply_err(f"{type(error).__name__}: {error}")

        queryable = self._session.declare_queryable(key, answer)
        return self._keep(queryable.undeclare)

    def ask(
        self, key: str, parameters: Mapping[str, str] | None = None, body: bytes = b"", timeout_s: float = 2.0
    ) -> list[Received]:
        """All answers within `timeout_s`, none when nobody serves the key. Raises RemoteError for an error answer."""
        replies = self._session.get(_selector(key, parameters), payload=body or None, **_question(timeout_s))
        answers = []
        for reply in replies:
            if reply.err is not None:
                reason = reply.err.payload.to_bytes().decode(errors="replace")
                if reason == TIMED_OUT:
                    continue
                raise RemoteError(reason)
            if reply.ok is not None:
                answers.append(_received(reply.ok))
        return answers

    def ask_again(self, key: str, body: bytes, timeout_s: float, tries: int) -> list[Received]:
        """As `ask`, and again when nothing comes back: for orders that mean the same however often they are given."""
        for left in range(tries - 1, -1, -1):
            answers = self.ask(key, body=body, timeout_s=timeout_s)
            if answers or left == 0:
                return answers
            time.sleep(PAUSE_S)
        return []

    def ask_later(
        self,
        key: str,
        parameters: Mapping[str, str],
        on_answer: Callable[[Received], None],
        on_done: Callable[[], None],
        timeout_s: float = 2.0,
    ) -> None:
        """As `ask` without waiting: `on_answer` for each, then `on_done` once; error answers are left out."""

        def take(reply: zenoh.Reply) -> None:
            if reply.ok is not None:
                on_answer(_received(reply.ok))

        handler = handlers.Callback(self._guarded(take), drop=on_done)
        self._session.get(_selector(key, parameters), handler, **_question(timeout_s))

    def declare_token(self, key: str) -> Handle:
        """Be visible under `key` for as long as this process is connected."""
        return self._keep(self._session.liveliness().declare_token(key).undeclare)

    def tokens(self, key: str, timeout_s: float = 1.0) -> list[str]:
        """Keys of the tokens that are held now."""
        replies = self._session.liveliness().get(key, timeout=timeout_s)
        return [str(reply.ok.key_expr) for reply in replies if reply.ok is not None]

    def watch_tokens(self, key: str, callback: Callable[[str, bool], None]) -> Handle:
        """callback(key, alive) for every token that is there, comes or goes."""

        def change(sample: zenoh.Sample) -> None:
            callback(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT)

        subscriber = self._session.liveliness().declare_subscriber(key, self._guarded(change), history=True)
        return self._keep(subscriber.undeclare)

    def close(self) -> None:
        """Leave. Never waits longer than a second: Zenoh's own close may hang on a dead link."""
        if self._closed:
            return
        self._closed = True
        closing = threading.Thread(target=self._close_session, name="bus-close", daemon=True)
        closing.start()
        closing.join(1.0)

    def _keep(self, undeclare: Callable[[], None]) -> Handle:
        """Zenoh takes back what nobody holds: the bus holds it until the handle is closed."""

        def take_back() -> None:
            self._declared.discard(handle)
            undeclare()

        handle = Handle(take_back)
        self._declared.add(handle)
        return handle

    def _close_session(self) -> None:
        try:
            self._session.close()  # type: ignore[no-untyped-call]
        except zenoh.ZError as error:
            logger.warning(event("close_failed", error=str(error)))

    def _guarded(self, callback: Callable[[Any], None], convert: Callable[[Any], Any] | None = None) -> Any:
        def call(item: Any) -> None:
            try:
                callback(item if convert is None else convert(item))
            except Exception:  # noqa: BLE001 - one bad message must not end a subscription
                self._count_error(getattr(callback, "__qualname__", "callback"))

        return call

    def _count_error(self, where: str) -> None:
        self.errors += 1
        logger.error(event("callback_failed", where=where, trace=traceback.format_exc()))


def _received(sample: zenoh.Sample) -> Received:
    attachment = sample.attachment
    return Received(
        str(sample.key_expr), b"" if attachment is None else attachment.to_bytes(), sample.payload.to_bytes()
    )


def _parameters(text: str) -> dict[str, str]:
    pairs = (part.partition("=") for part in text.split(";") if part)
    return {name: value for name, _, value in pairs}


def _selector(key: str, parameters: Mapping[str, str] | None) -> str:
    return key if not parameters else key + "?" + ";".join(f"{name}={value}" for name, value in parameters.items())


def _question(timeout_s: float) -> dict[str, Any]:
    """Everyone who serves the key answers, each answer is kept, and none may block the way back (DROP)."""
    return {
        "target": zenoh.QueryTarget.ALL,
        "consolidation": zenoh.ConsolidationMode.NONE,
        "congestion_control": zenoh.CongestionControl.DROP,
        "timeout": timeout_s,
    }
