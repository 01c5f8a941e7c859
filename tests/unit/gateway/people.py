"""Accounts for tests, without the time that a password takes."""

from datetime import UTC, datetime

from fastapi import FastAPI
from fastapi.testclient import TestClient

from services.gateway.access import sign_ins
from services.gateway.access.identify import COOKIE
from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.accounts.records import add_account, find_login
from services.gateway.tables import ClinicRow


def sign_in(client: TestClient, role: Role, clinic: str = "main", login: str | None = None) -> str:
    """Give the browser the sign-in of an account, which is made when it is not there; id of the account."""
    account, value = _begin(client.app, role, clinic, login)
    client.cookies.set(COOKIE, value)
    return account


def cookie(app: FastAPI, role: Role, clinic: str = "main") -> str:
    """The same as a header's text, for clients that are no TestClient."""
    return f"{COOKIE}={_begin(app, role, clinic, None)[1]}"


def _begin(app: FastAPI, role: Role, clinic: str, login: str | None) -> tuple[str, str]:
    name = login or f"{role}.{clinic}"
    now = datetime.now(UTC)
    with app.state.gateway.database.transaction(EVERYTHING) as database:
        if database.get(ClinicRow, clinic) is None:
            database.add(ClinicRow(id=clinic, name=clinic.title(), keep_days=None, created=now))
            database.flush()
        account = find_login(database, name) or add_account(database, name, role, clinic, None)
        database.flush()
        return account.id, sign_ins.begin(database, account, now)
