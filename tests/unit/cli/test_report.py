import json
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest
from typer.testing import CliRunner

from services.cli.__main__ import app


class Answers(BaseHTTPRequestHandler):
    """A gateway that has one finished session."""

    def do_GET(self):
        known = self.path.startswith("/v1/sessions/walk/")
        problem = {"detail": "There is no session.", "next_step": "List them."}
        body = f"asked {self.path}".encode() if known else json.dumps(problem).encode()
        self.send_response(200 if known else 404)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *args):
        """Nothing."""


@pytest.fixture
def url():
    with HTTPServer(("127.0.0.1", 0), Answers) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()
        thread.join()


def run(*words):
    return CliRunner().invoke(app, ["report", *map(str, words)])


@pytest.mark.parametrize(("ending", "form"), [("pdf", "report.pdf"), ("html", "report.html"), ("json", "report")])
def test_the_ending_of_the_file_chooses_what_is_asked_for(url, tmp_path, ending, form):
    file = tmp_path / f"walk.{ending}"
    result = run("walk", "--out", file, "--language", "fr", "--url", url)
    assert result.exit_code == 0
    assert file.read_text() == f"asked /v1/sessions/walk/{form}?language=fr"
    assert list(tmp_path.iterdir()) == [file]


def test_a_refusal_is_told_with_the_next_step(url, tmp_path):
    result = run("nobody", "--out", tmp_path / "walk.pdf", "--url", url)
    assert result.exit_code == 1
    assert "There is no session. List them." in result.output.replace("\n", " ")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--out", "walk.doc"), "the ending must be one of"),
        (("--out", "walk.pdf", "--url", "http://127.0.0.1:1"), "no gateway answers"),
        (("--out", "walk.pdf", "--url", "file:///etc/hostname"), "begins with http"),
    ],
)
def test_what_cannot_work_is_said(words, told):
    result = run("walk", *words)
    assert result.exit_code == 1
    assert told in result.output.replace("\n", " ")
