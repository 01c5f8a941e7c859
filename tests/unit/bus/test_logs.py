"""Lines of a log: one per event, readable by machines, and without secrets or names."""

import json
import logging
import sys
import threading

import pytest

from services.bus.logs import LogSettings, event, set_up_logging
from services.bus.redaction import BLANK, is_secret, redacted_text

SECRETS = {
    "a machine's key": "refused ambula_0123456789ab_Zx8-uvWxYz_0123456789 today",
    "a bearer header": "Authorization: Bearer Zx8uvWxYz0123456789",
    "a cookie header": "'cookie': 'theme=dark; ambula=0123456789abcdef.Zx8uvWxYz0123456789abc'",
    "a cookie": "sent __Host-ambula=0123456789abcdef.Zx8uvWxYz0123456789abc;",
    "a sign-in": "0123456789abcdef.Zx8uvWxYz0123456789abc",
    "a token": "id eyJhbGciOi.eyJzdWIiZx8uvWxYz.c2lnbmF0dXJl",
    "a kept password": "$argon2id$v=19$m=65536,t=3,p=4$Zx8uvWxYz$abc",
    "an address": "postgresql+psycopg://ambula:Zx8uvWxYz@database/ambula",
    "a password": 'body {"login": "x", "password": "Zx8uvWxYz 1"}',
    "a name": "new_name = Mona Zx8uvWxYz, year 1957",
    "what a statement was given": "UPDATE t SET a=1\n[parameters: ('Zx8uvWxYz', 'b')]\n(Background on this error)",
    "what a validator was given": "1 error\n  wrong [type=x, input_value='Zx8uvWxYz', input_type=str]",
}


@pytest.fixture
def logged(capsys):
    """Lines that the code under test logs; everything is put back afterwards."""
    root = logging.getLogger()
    before = root.handlers[:], root.level, sys.excepthook, threading.excepthook

    def lines():
        return capsys.readouterr().err.splitlines()

    yield lines
    root.handlers[:], root.level, sys.excepthook, threading.excepthook = before


@pytest.mark.parametrize("what", SECRETS)
def test_what_looks_like_a_secret_is_blanked(what):
    text = redacted_text(SECRETS[what])
    assert "Zx8" not in text
    assert BLANK in text


@pytest.mark.parametrize(
    "field", ["name", "new_password", "apiKey", "Set-Cookie", "authorization", "record_number", "former_secret", "keys"]
)
def test_fields_that_hold_secrets(field):
    assert is_secret(field)


def test_ordinary_fields_and_texts_are_left_alone():
    for field in ("session", "patient", "code", "keyboard", "reason", "renamed", "router", "monkey"):
        assert not is_secret(field), field
    for text in ("session 8d0c2a71f04be655 of K7QM3F", "no router at tcp/127.0.0.1:7447", "1.25 s; name 'x' unknown"):
        assert redacted_text(text) == text


def test_logfmt_is_one_line_with_the_event_after_the_service(logged):
    set_up_logging("metrics", style="logfmt")
    said = event("opened", session="s1", reason="two words\u2028and\nmore", count=2, ok=True, password="x", none=None)
    logging.getLogger("test").warning(said)
    (line,) = logged()
    time, rest = line.split(" ", 1)
    assert time.startswith("time=20")
    assert rest == (
        'level=warning service=metrics event=opened session=s1 reason="two words\\\\nand\\nmore" '
        f"count=2 ok=true password={BLANK} none="
    )


def test_json_has_the_same_fields_with_their_types(logged):
    set_up_logging("metrics", style="json")
    logging.getLogger("test").info(event("opened", session="s1", count=2, inner={"name": "Mona", "x": [1, "a"]}))
    entry = json.loads(logged()[0])
    assert list(entry)[:4] == ["time", "level", "service", "event"]
    assert (entry["event"], entry["count"], entry["inner"]) == ("opened", 2, {"name": BLANK, "x": [1, "a"]})


@pytest.mark.parametrize("style", ["logfmt", "json"])
def test_an_exception_is_on_the_line_without_what_it_must_not_tell(logged, style):
    set_up_logging("gateway", style=style)
    try:
        try:
            raise ValueError("password='Zx8uvWxYz'")
        except ValueError as error:
            raise RuntimeError("Bearer Zx8uvWxYz0123") from error
    except RuntimeError as error:
        logging.getLogger("test").exception(event("failed", reason=error, where="here"))
    (line,) = logged()
    assert "RuntimeError" in line
    assert "ValueError" in line
    assert "Zx8" not in line


def test_what_a_library_says_is_a_message_and_blanked_too(logged):
    set_up_logging("gateway")
    logging.getLogger("uvicorn").warning("refused %s from %s", "ambula_0123456789ab_Zx8uvWxYz", "a\nb")
    (line,) = logged()
    assert 'service=gateway event=message text="refused ' in line
    assert "Zx8" not in line


def test_the_end_of_a_thread_is_an_event(logged):
    set_up_logging("archive")

    def fail():
        raise OSError("token=Zx8uvWxYz")

    thread = threading.Thread(target=fail, name="writer")
    thread.start()
    thread.join()
    (line,) = logged()
    assert "level=critical service=archive event=thread_crashed thread=writer" in line
    assert "Zx8" not in line


def test_the_end_of_the_process_is_an_event(logged):
    set_up_logging("archive")
    error = RuntimeError("secret: Zx8uvWxYz")
    sys.excepthook(RuntimeError, error, None)
    (line,) = logged()
    assert "event=crashed" in line
    assert "Zx8" not in line


def test_fields_do_not_hide_the_line_itself(logged):
    set_up_logging("archive")
    logging.getLogger("test").info(event("opened", level="left", time=3, service="ingest"))
    (line,) = logged()
    assert "level=info service=ingest event=opened level_=left time_=3" in line


def test_the_style_comes_from_the_environment(monkeypatch):
    monkeypatch.setenv("AMBULA_LOG", "json")
    assert LogSettings().log == "json"
    monkeypatch.setenv("AMBULA_LOG", "xml")
    with pytest.raises(ValueError, match="log"):
        LogSettings()
