"""Logs: one line per event, on standard error. Logfmt unless AMBULA_LOG asks for JSON; secrets and names never."""

import json
import logging
import sys
import threading
from types import TracebackType
from typing import Any, Literal

import structlog
from pydantic_settings import BaseSettings, SettingsConfigDict
from structlog.typing import EventDict, Processor

from services.bus.redaction import redacted

FIRST = ("time", "level", "service", "event")


class LogSettings(BaseSettings):
    """How lines look, from AMBULA_LOG."""

    model_config = SettingsConfigDict(env_prefix="AMBULA_", frozen=True)

    log: Literal["logfmt", "json"] = "logfmt"


class Event(str):
    """One thing that happened, with its fields; as text for whoever knows no better."""

    __slots__ = ("fields", "kind")
    kind: str
    fields: dict[str, object]

    def __new__(cls, kind: str, fields: dict[str, object]) -> "Event":
        """The text is made here, as a str cannot be changed later."""
        words = [f"event={kind}", *(f"{field}={_word(value)}" for field, value in redacted(fields).items())]
        made = super().__new__(cls, " ".join(words))
        made.kind, made.fields = kind, fields
        return made


def event(kind: str, /, **fields: object) -> Event:
    """An event to be logged: `logger.info(event("session_opened", session=session))`."""
    return Event(kind, fields)


def set_up_logging(service: str, level: int = logging.INFO, style: str | None = None) -> None:
    """Send this process's log to standard error, one line per event; what ends a thread or the process, too."""
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(_formatter(service, style or LogSettings().log))
    logging.basicConfig(level=level, handlers=[handler], force=True)
    sys.excepthook = _log_crash
    threading.excepthook = _log_thread_crash


def _formatter(service: str, style: str) -> structlog.stdlib.ProcessorFormatter:
    def of_service(_: object, __: str, entry: EventDict) -> EventDict:
        entry.setdefault("service", service)
        return entry

    steps: list[Processor] = [
        _unpack,
        structlog.stdlib.add_log_level,
        of_service,
        structlog.processors.TimeStamper(fmt="iso", utc=True, key="time"),
        structlog.processors.format_exc_info,
        structlog.stdlib.ProcessorFormatter.remove_processors_meta,
        _redact,
        _writable,
        _render_json if style == "json" else structlog.processors.LogfmtRenderer(key_order=FIRST, bool_as_flag=False),
    ]
    return structlog.stdlib.ProcessorFormatter(processors=steps)


def _unpack(_: object, __: str, entry: EventDict) -> EventDict:
    """Our events bring their fields; what a library says is a text."""
    said = entry["_record"].msg
    if isinstance(said, Event):
        return {**entry, "event": said.kind} | {_unlike(field): value for field, value in said.fields.items()}
    return {**entry, "event": "message", "text": entry["event"]}


def _unlike(field: str) -> str:
    """A field must not hide the line's own."""
    return f"{field}_" if field in ("event", "level", "time", "_record", "_from_structlog", "exc_info") else field


def _redact(_: object, __: str, entry: EventDict) -> EventDict:
    return redacted(dict(entry))


def _writable(_: object, __: str, entry: EventDict) -> EventDict:
    """One line, whatever is in it: no other character than a blank separates."""
    return {field.replace(" ", "_"): _flat(value) for field, value in entry.items()}


def _flat(value: object) -> object:
    if value is None or isinstance(value, bool | int | float | list | dict):
        return value
    return str(value).replace("\r", "\\r").replace("\x0b", "\\v").replace("\x0c", "\\f").replace("\u2028", "\\n")


def _render_json(_: object, __: str, entry: EventDict) -> str:
    ordered = {field: entry[field] for field in FIRST if field in entry} | dict(entry)
    return json.dumps(ordered, default=str, ensure_ascii=False)


def _log_crash(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    if issubclass(kind, KeyboardInterrupt):
        sys.__excepthook__(kind, error, trace)
        return
    logging.getLogger("crash").critical(event("crashed"), exc_info=(kind, error, trace))


def _log_thread_crash(told: Any) -> None:
    if told.exc_type is SystemExit:
        return
    thread = None if told.thread is None else told.thread.name
    trace = (told.exc_type, told.exc_value, told.exc_traceback)
    logging.getLogger("crash").critical(event("thread_crashed", thread=thread), exc_info=trace)


def _word(value: object) -> str:
    text = str(value)
    return json.dumps(text, ensure_ascii=False) if not text or any(mark in text for mark in ' "\n=') else text
