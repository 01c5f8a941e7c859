"""What runs behind `ambula up`: the router in this process, every service as a child that is kept alive."""

import logging
import os
import signal
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import FrameType
from typing import Any, Self

from schemas.health import Health, Readiness
from schemas.signals import health_key, service_token_key
from services.bus.connection import Bus
from services.bus.lifetime import SUPERVISOR_VARIABLE
from services.bus.logs import event
from services.bus.received import Received
from services.bus.router import Router, open_router
from services.bus.settings import BusSettings

STOP_ORDER = ("ingest", "estimation", "segmentation", "metrics", "archive", "gateway")
"""Down the stream, so that each still hears what the one before it said last."""
STOP_PATIENCE_S = 5.0
FIRST_BACK_OFF_S = 0.2
LONGEST_BACK_OFF_S = 5.0
HEALTHY_AFTER_S = 10.0
"""A child that lived this long is started again after the first back-off."""
LAST_WORDS = 12
"""Log lines of a child that are shown when it does not start."""
LOOK_S = 0.05

logger = logging.getLogger(__name__)


class NotReady(TimeoutError):
    """A service did not come up in time."""


@dataclass
class _Child:
    """One service and the process that runs it at present."""

    name: str
    process: subprocess.Popen[str]
    started: float
    instances: set[str] = field(default_factory=set)
    compiling: bool = False
    last_words: deque[str] = field(default_factory=lambda: deque(maxlen=LAST_WORDS))
    back_off_s: float = FIRST_BACK_OFF_S
    restarts: int = 0
    restart_at: float | None = None


def write_line(line: str) -> None:
    """Pass a line on to standard error."""
    sys.stderr.write(line + "\n")


class Supervisor:
    """A context manager: inside it the services run, after it they have stopped, in order.

    `settings` has the endpoint that was chosen when the router was to take a free port. Raises RouterUnavailable on
    entering when the port is taken. Each line of a child's log goes to `output` behind the service's name.
    """

    def __init__(
        self,
        services: Sequence[str],
        settings: BusSettings,
        environment: Mapping[str, str] | None = None,
        output: Callable[[str], None] = write_line,
    ) -> None:
        self.services = tuple(services)
        self.settings = settings
        self._environment = dict(environment or {})
        self._output = output
        self._children: dict[str, _Child] = {}
        self._lock = threading.Lock()
        self._stopping = threading.Event()
        self._router: Router | None = None
        self._bus: Bus | None = None
        self._previous_handler: Any = None

    def __enter__(self) -> Self:
        self._router = open_router(self.settings)
        self.settings = BusSettings(router=self._router.endpoint, site=self.settings.site)
        if threading.current_thread() is threading.main_thread():
            self._previous_handler = signal.signal(signal.SIGTERM, _interrupt)
        try:
            self._bus = Bus.open(self.settings, "supervisor")
            self._bus.watch_tokens(service_token_key(self.settings.site, "*", "*"), self._note_token)
            self._bus.subscribe(health_key(self.settings.site, "*", "*"), self._note_health)
            for name in self.services:
                self._children[name] = _Child(name, self._spawn(name), time.monotonic())
            threading.Thread(target=self._watch, name="supervisor", daemon=True).start()
        except BaseException:
            self._stop()
            raise
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> bool:
        """Stop everything. Ctrl-C and SIGTERM are the ordinary way to end, at whatever moment they come."""
        self._stop()
        return kind is KeyboardInterrupt

    def wait_until_ready(
        self, timeout_s: float = 60.0, tell: Callable[[list[str], list[str]], None] = lambda _missing, _compiling: None
    ) -> None:
        """Wait for every service's token, telling who is missing and who of them compiles what it runs.

        While one compiles, the clock stands still: how long that takes is the machine's business. Raises NotReady with
        the last words of those that are missing.
        """
        end = time.monotonic() + timeout_s
        while missing := [child for child in self._children.values() if not child.instances]:
            compiling = [child.name for child in missing if child.compiling]
            tell([child.name for child in missing], compiling)
            if compiling:
                end += LOOK_S
            if time.monotonic() >= end:
                words = "\n".join(f"  {child.name} | {line}" for child in missing for line in child.last_words)
                names = ", ".join(child.name for child in missing)
                raise NotReady(f"not ready after {timeout_s:.0f} s: {names}. Last words:\n{words}")
            time.sleep(LOOK_S)

    def run(self, seconds: float | None = None) -> None:
        """Stay until Ctrl-C, SIGTERM, or for so many seconds."""
        end = None if seconds is None else time.monotonic() + seconds
        try:
            while end is None or time.monotonic() < end:
                time.sleep(LOOK_S)
        except KeyboardInterrupt:
            logger.info(event("interrupted"))

    def pid(self, name: str) -> int:
        """Process id of a service's present child."""
        return self._children[name].process.pid

    def restarts(self, name: str) -> int:
        """How often a service's child was started again."""
        return self._children[name].restarts

    def kill(self, name: str) -> None:
        """End a child as a crash would (SIGKILL); it is started again. Returns when the process is gone."""
        with self._lock:
            child = self._children[name]
            child.process.kill()
            child.process.wait()
            child.instances.clear()
            child.compiling = False

    def _spawn(self, name: str) -> subprocess.Popen[str]:
        environment = {
            **os.environ,
            **self._environment,
            "AMBULA_ROUTER": self.settings.router,
            "AMBULA_SITE": self.settings.site,
            SUPERVISOR_VARIABLE: str(os.getpid()),
        }
        process = subprocess.Popen(
            [sys.executable, "-m", f"services.{name}"],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            start_new_session=True,  # Ctrl-C is for the supervisor, which stops its children in order
        )
        threading.Thread(target=self._pass_on, args=(name, process), name=f"log-{name}", daemon=True).start()
        return process

    def _pass_on(self, name: str, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        with process.stdout as lines:
            for line in lines:
                self._output(f"{name:<12} | {line.rstrip()}")
                child = self._children.get(name)
                if child is not None:
                    child.last_words.append(line.rstrip())

    def _note_token(self, key: str, alive: bool) -> None:
        _, name, instance = key.rsplit("/", 2)
        child = self._children.get(name)
        if child is None:
            return
        (child.instances.add if alive else child.instances.discard)(instance)

    def _note_health(self, received: Received) -> None:
        report = Health.model_validate_json(received.payload)
        child = self._children.get(report.service)
        if child is not None:
            child.compiling = report.readiness is Readiness.COMPILING

    def _watch(self) -> None:
        while not self._stopping.wait(LOOK_S):
            with self._lock:
                for child in self._children.values():
                    self._look_at(child, time.monotonic())

    def _look_at(self, child: _Child, now: float) -> None:
        status = child.process.poll()
        if status is None or self._stopping.is_set():
            return
        if child.restart_at is None:
            if now - child.started >= HEALTHY_AFTER_S:
                child.back_off_s = FIRST_BACK_OFF_S
            child.restart_at = now + child.back_off_s
            child.back_off_s = min(2 * child.back_off_s, LONGEST_BACK_OFF_S)
            news = event("child_ended", service=child.name, status=status, restarts=child.restarts)
            self._output(f"{'supervisor':<12} | {news}")
        if now >= child.restart_at:
            child.restart_at = None
            child.restarts += 1
            child.compiling = False
            child.started = now
            child.process = self._spawn(child.name)

    def _stop(self) -> None:
        self._stopping.set()
        order = {name: place for place, name in enumerate(STOP_ORDER)}
        try:
            with self._lock:
                for child in sorted(self._children.values(), key=lambda child: order.get(child.name, -1)):
                    _end(child.process)
        finally:
            for child in self._children.values():
                child.process.kill()
                child.process.wait()
            if self._bus is not None:
                self._bus.close()
            if self._router is not None:
                self._router.close()
            if self._previous_handler is not None:
                signal.signal(signal.SIGTERM, self._previous_handler)
                self._previous_handler = None


def _end(process: subprocess.Popen[str]) -> None:
    """Ask the process to end; insist after a while."""
    process.terminate()
    try:
        process.wait(STOP_PATIENCE_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt
