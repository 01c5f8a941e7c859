"""Who a patient is: found however it is written, by those who may, and nowhere to be read in clear."""

import io
import logging

import pytest

from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.audit import records
from services.gateway.directory.cipher import Cipher, DirectoryUnusable, Name
from services.gateway.directory.words import folded, matching
from tests.unit.gateway import people

ERIKA = {"name": "Erika Müller-Łoś", "record_number": "4711-2026"}


def register(client, **name):
    code = client.post("/v1/patients", json={}).json()["code"]
    if name:
        assert client.put(f"/v1/patients/{code}/name", json=name).status_code == 200
    return code


def search(client, text):
    return [each["code"] for each in client.post("/v1/directory/search", json={"text": text}).json()["items"]]


@pytest.mark.parametrize("text", ["muller", "MÜLLER", "los erika", "4711", "erika 2026", "ller-l"])
def test_whatever_is_typed_of_it_finds_it(text):
    assert matching(text)(Name(**ERIKA))


@pytest.mark.parametrize("text", ["mueller", "erika schmidt", "4712", "  "])
def test_what_is_not_in_it_does_not(text):
    assert not matching(text)(Name(**ERIKA))


def test_letters_that_unicode_does_not_take_apart():
    assert folded("Øst Đorđe Æther ŒUVRE Straße") == "ost dorde aether oeuvre strasse"


def test_a_name_is_kept_changed_found_and_forgotten(client):
    code = register(client, **ERIKA)
    assert client.get(f"/v1/patients/{code}/name").json() == {"code": code} | ERIKA
    client.put(f"/v1/patients/{code}/name", json={"name": "  Erika Musterfrau "})
    expected = {"code": code, "name": "Erika Musterfrau", "record_number": None}
    assert client.get(f"/v1/patients/{code}/name").json() == expected
    assert (search(client, "MUSTER"), search(client, "4711")) == ([code], [])
    assert client.delete(f"/v1/patients/{code}/name").status_code == 204
    assert client.get(f"/v1/patients/{code}/name").status_code == 404
    assert client.delete(f"/v1/patients/{code}/name").status_code == 404
    assert search(client, "MUSTER") == []


def test_many_names_are_asked_for_at_once(client):
    codes = [register(client, name=name) for name in ("Özil", "Adler", "Zander")]
    nameless = register(client)
    answer = client.post("/v1/directory/names", json={"codes": [nameless, "NONE", *codes]}).json()
    assert [each["name"] for each in answer["items"]] == ["Adler", "Özil", "Zander"]
    assert answer["more"] is False


def test_another_clinic_finds_and_changes_nothing(client):
    code = register(client, **ERIKA)
    people.sign_in(client, Role.ADMIN, "other")
    assert search(client, "erika") == []
    assert client.post("/v1/directory/names", json={"codes": [code]}).json()["items"] == []
    for ask in (client.get, client.delete):
        assert ask(f"/v1/patients/{code}/name").status_code == 404
    assert client.put(f"/v1/patients/{code}/name", json=ERIKA).status_code == 404


@pytest.mark.parametrize("role", [Role.VIEWER, Role.SERVICE])
def test_names_are_not_for_everybody(client, role):
    code = register(client, **ERIKA)
    people.sign_in(client, role)
    assert client.get(f"/v1/patients/{code}/name").status_code == 403
    assert client.post("/v1/directory/search", json={"text": "erika"}).status_code == 403


def test_names_are_read_in_the_audit_by_code_alone(client, gateway):
    code = register(client, **ERIKA)
    for _ in range(3):
        search(client, "erika")
    with gateway.database.transaction(EVERYTHING) as database:
        entries = [records.entry_in(row) for row in records.entries_from(database, 1, 100)]
    assert [(each.action, each.patient) for each in entries] == [
        ("create_patient", code), ("put_name", code), ("search_names", code),
    ]  # fmt: skip
    assert "rika" not in str(entries)


def test_nowhere_in_clear_neither_on_disk_nor_in_the_log(client, settings, tmp_path):
    heard = io.StringIO()
    handler = logging.StreamHandler(heard)
    logging.getLogger().addHandler(handler)
    try:
        code = register(client, name="Erika MARKER", record_number="RN-MARKER")
        search(client, "marker")
        assert client.put(f"/v1/patients/{code}/name", json={"name": "MARKER\nMARKER"}).status_code == 422
        answer = client.put(f"/v1/patients/{code}/name", json={"name": 7, "surname": "MARKER"})
    finally:
        logging.getLogger().removeHandler(handler)
    assert "MARKER" not in heard.getvalue() + answer.text
    files = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert settings.directory_key in files
    assert [path.name for path in files if b"MARKER" in path.read_bytes()] == []
    directory = (settings.own_dir / "directory.sqlite").read_bytes()
    assert code.encode() not in directory
    assert settings.directory_key.stat().st_mode & 0o777 == 0o600


def test_a_lost_or_wrong_key_is_told_and_never_replaced(client, settings):
    code = register(client, **ERIKA)
    key = settings.directory_key.read_text()
    settings.directory_key.unlink()
    for answer in (client.get(f"/v1/patients/{code}/name"), client.put(f"/v1/patients/{code}/name", json=ERIKA)):
        assert (answer.status_code, "key of the directory is gone" in answer.json()["detail"]) == (503, True)
    assert not settings.directory_key.exists()
    settings.directory_key.write_text("0" * 63)
    assert client.get(f"/v1/patients/{code}/name").status_code == 503
    settings.directory_key.write_text(key)
    assert client.get(f"/v1/patients/{code}/name").json()["name"] == ERIKA["name"]


def test_an_entry_opens_for_its_patient_under_its_key_alone():
    cipher, name = Cipher(b"k" * 32), Name(**ERIKA)
    sealed = cipher.seal("K7QM3F", name)
    assert cipher.open("K7QM3F", sealed) == name
    assert sealed != cipher.seal("K7QM3F", name)
    changed = bytes([sealed[0] ^ 1]) + sealed[1:]
    for other, code, text in (
        (Cipher(b"x" * 32), "K7QM3F", sealed),
        (cipher, "A", sealed),
        (cipher, "K7QM3F", changed),
    ):
        with pytest.raises(DirectoryUnusable):
            other.open(code, text)
