"""Logs: one line per event, key=value, on standard error."""

import json
import logging
import sys


class _OneLine(logging.Formatter):
    """Time, level, service and the event on one line, whatever is in it."""

    def __init__(self, service: str) -> None:
        super().__init__(f"%(asctime)s.%(msecs)03d %(levelname)s service={service} %(message)s", "%Y-%m-%dT%H:%M:%S")

    def format(self, record: logging.LogRecord) -> str:
        return super().format(record).replace("\n", "\\n")


def set_up_logging(service: str, level: int = logging.INFO) -> None:
    """Send this process's log to standard error, one line per event."""
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(_OneLine(service))
    logging.basicConfig(level=level, handlers=[handler], force=True)


def event(name: str, **fields: object) -> str:
    """The text of one event; values with blanks or quotes are quoted."""
    return " ".join([f"event={name}", *(f"{key}={_word(value)}" for key, value in fields.items())])


def _word(value: object) -> str:
    text = str(value)
    return json.dumps(text, ensure_ascii=False) if not text or any(mark in text for mark in ' "\n=') else text
