"""Several browsers at one gateway, whose passwords cost next to nothing."""

import shutil
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from argon2 import PasswordHasher
from fastapi.testclient import TestClient
from sqlalchemy import select

from services.gateway.access.identify import COOKIE
from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import AccountRow, SignInRow
from services.gateway.accounts.passwords import Passwords
from services.gateway.accounts.records import add_account, find_login
from services.gateway.audit.tables import AuditRow
from services.gateway.database import open_database
from tests.unit.gateway import people

PASSWORD = "three quiet steps"


class Verifications(PasswordHasher):
    """Counts what is computed."""

    def __init__(self) -> None:
        super().__init__(time_cost=1, memory_cost=8, parallelism=1)
        self.costs: list[str] = []

    def verify(self, hash: str, password: bytes) -> bool:
        self.costs.append("$".join(hash.split("$")[:4]))
        return super().verify(hash, password)


def hold(browser, value):
    """Have a browser hold a sign-in as if the gateway had given it."""
    browser.cookies.clear()
    browser.cookies.set(COOKIE, value, domain="testserver.local")


class Clinic:
    """The gateway as the tests see it from behind, and the browsers before it."""

    def __init__(self, app):
        self.app = app
        self.hasher = Verifications()
        app.state.gateway = replace(app.state.gateway, passwords=Passwords(self.hasher))

    @property
    def gateway(self):
        return self.app.state.gateway

    def browser(self, role=None, clinic="main", login=None, site_admin=False):
        """A browser, signed in when a role is given."""
        browser = TestClient(self.app)
        if role is not None:
            browser.account = people.sign_in(browser, role, clinic, login)
            hold(browser, browser.cookies[COOKIE])
            if site_admin:
                self.change(browser.account, site_admin=True)
        return browser

    def account(self, login, password=PASSWORD, role=Role.THERAPIST, clinic="main"):
        """An account with a password; its id."""
        kept = None if password is None else self.gateway.passwords.keep(password)
        with self.gateway.database.transaction(EVERYTHING) as database:
            row = add_account(database, login, role, clinic, kept)
            database.flush()
            return row.id

    def find(self, login):
        with self.gateway.database.transaction(EVERYTHING) as database:
            return find_login(database, login)

    def change(self, account, **values):
        with self.gateway.database.transaction(EVERYTHING) as database:
            row = database.get_one(AccountRow, account)
            for name, value in values.items():
                setattr(row, name, value)

    def age_sign_ins(self, **seconds):
        """Let time pass for every sign-in: `renewed=61` means that it was renewed 61 s longer ago."""
        with self.gateway.database.transaction(EVERYTHING) as database:
            for row in database.scalars(select(SignInRow)):
                for name, value in seconds.items():
                    setattr(row, name, getattr(row, name) - timedelta(seconds=value))

    def unlock(self, account):
        """Let the time pass for which wrong passwords have closed an account."""
        self.change(account, locked_until=datetime.now(UTC) - timedelta(milliseconds=1))

    def sign_ins(self):
        with self.gateway.database.transaction(EVERYTHING) as database:
            return list(database.scalars(select(SignInRow)))

    def audit(self):
        with self.gateway.database.transaction(EVERYTHING) as database:
            return list(database.scalars(select(AuditRow).order_by(AuditRow.number)))


@pytest.fixture(scope="session")
def new_database(tmp_path_factory):
    """A database as it is at the first start, made once."""
    path = tmp_path_factory.mktemp("new") / "gateway.sqlite"
    open_database(f"sqlite:///{path}").close()
    return path


@pytest.fixture
def settings(settings, new_database, tmp_path):
    shutil.copy(new_database, tmp_path / "gateway.sqlite")
    return settings


@pytest.fixture
def clinic(stranger):
    return Clinic(stranger.app)
