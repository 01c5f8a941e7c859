"""Every page of the table, for whoever may see it and for whoever may not; and coming in and going out."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

from services.bus.settings import BusSettings
from services.cli import browser as browsers
from services.cli.door import Door
from services.cli.supervisor import Supervisor
from services.gateway.accounts.first_run import code_file
from tests.system import axe, pages
from tests.system.pages import keep, text, wait

pytestmark = pages.NEEDED

WIDE, NARROW = (1366, 768), (390, 844)
PASSWORD = "three quiet steps go"
NOT_FOR_YOU = "This page is not for your role"
GO = """
if (location.hash === arguments[0]) return;
document.querySelector("main").dataset.address = "";
location.hash = arguments[0];
"""
FOCUS = "return document.activeElement.tagName"
TABLE = """
const done = arguments[arguments.length - 1];
fetch("/static/names.json")
  .then((answer) => answer.json())
  .then((names) => import(`/static/${names["pages.js"]}`))
  .then(({ PAGES }) => done(PAGES.map(({ load, ...page }) => page)));
"""


@dataclass(frozen=True)
class Shown:
    """What the pages of a clinic are about: a patient, and sessions of which one walks."""

    site: pages.Site
    patient: str
    walking: str
    over: str

    def addresses(self, pattern: str) -> list[str]:
        """Where a page of the table is, once for each thing that can be looked at there."""
        path = re.sub(r"/?:\w+\?", "", pattern).replace(":patient", self.patient)
        sessions = [self.walking, self.over] if ":session" in path else [""]
        return [f"#/{path.replace(':session', session)}" for session in sessions]


@pytest.fixture(scope="module")
def clinic(floor: pages.Site) -> Iterator[Shown]:
    """A floor with somebody to look at, and a viewer."""
    door = floor.door
    patient = door.ask("patients", {})["code"]
    over = pages.begin(door, "synthetic:knee?worn=1&seed=2&duration=12", None)
    walking = pages.begin(door, "synthetic:walk?worn=1&seed=4&duration=600")
    door.ask(f"sessions/{over}", {"patient": patient}, "PATCH")
    for login, role in (("onlooker", "viewer"), ("s.lind", "admin")):
        door.ask("accounts", {"login": login, "role": role, "password": PASSWORD})
    door.ask("keys", {"name": "hospital export", "role": "viewer", "days": 30})
    door.ask("devices", {"name": "Set B", "kind": "sensor_set"})
    yield Shown(floor, patient, walking, over)
    pages.end_all(door)


@pytest.fixture(scope="module")
def window() -> Iterator[Chrome]:
    """One browser for all of them; drawing in three dimensions would take most of the time."""
    with browsers.open_browser(*WIDE, "--force-prefers-reduced-motion") as window:
        yield window


@pytest.fixture
def page(window: Chrome) -> Chrome:
    """The browser as if it were new: nobody has signed in, and nothing has been said."""
    window.get("about:blank")
    window.execute_cdp_cmd("Network.clearBrowserCookies", {})
    size(window, *WIDE)
    browsers.complaints(window)
    browsers.hosts_asked(window)
    return window


def enter(url: str, login: str) -> Door:
    door = Door(url)
    door.ask("sign-in", {"login": login, "password": PASSWORD})
    return door


def table(page: Chrome) -> list[dict]:
    return page.execute_async_script(TABLE)


def size(page: Chrome, width: int, height: int) -> None:
    metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
    page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)


def open_page(page: Chrome, address: str) -> str:
    """Go there as a link does; the heading there, or where the page leads on to."""
    page.execute_script(GO, address)
    return wait(page, lambda: text(page, "main:not([data-address='']) h1"), f"a heading at {address}")


def too_wide(page: Chrome) -> bool:
    return page.execute_script("return document.documentElement.scrollWidth > innerWidth")


@pytest.mark.parametrize("role", ["admin", "viewer"])
def test_every_page_can_be_used_by_everybody_and_asks_nobody_else(clinic, page, role):
    site = clinic.site
    browsers.admit(page, site.door if role == "admin" else enter(site.url, "onlooker"))
    page.get(site.url)
    wait(page, lambda: text(page, "main h1"), "the first page")
    me = page.execute_async_script("fetch('/v1/me').then((it) => it.json()).then(arguments[0])")
    wrong, opened = [], 0
    for entry in table(page):
        if entry["permission"] is None:
            continue
        for address in clinic.addresses(entry["pattern"]):
            size(page, *WIDE)
            heading = open_page(page, address)
            opened += 1
            assert (heading != NOT_FOR_YOU) == (entry["permission"] in me["may"]), address
            if heading == NOT_FOR_YOU:
                continue
            assert page.title.endswith(" – Ambula"), address
            wrong += [f"{address}: {fault}" for fault in axe.violations(page)]
            keep(page, f"{role}-{entry['name']}")
            size(page, *NARROW)
            if too_wide(page):
                wrong.append(f"{address}: wider than a phone")
            keep(page, f"{role}-{entry['name']}-narrow")
    assert wrong == []
    assert opened > 10
    assert browsers.complaints(page) == []
    assert browsers.hosts_asked(page) == {site.url.removeprefix("http://")}


def fill_in(page: Chrome, label: str, value: str) -> None:
    """Type into the field under a label."""
    field = page.find_element(By.XPATH, f"//label[normalize-space()='{label}']/following-sibling::*[1]")
    field.clear()
    field.send_keys(value)


def press(page: Chrome, word: str) -> None:
    """The button with these words; in a row they end with what the row is about."""
    page.find_element(By.XPATH, f"//button[normalize-space()='{word}']").click()


def place(page: Chrome) -> str:
    return page.execute_script("return location.hash")


def sign_in(page: Chrome, login: str, password: str) -> None:
    wait(page, lambda: page.find_elements(By.NAME, "login"), "the sign-in page")
    fill_in(page, "Name", login)
    fill_in(page, "Password", password)
    press(page, "Sign in")


def test_signing_in_leads_back_to_where_one_was_and_signing_out_ends_it(clinic, page):
    page.get(f"{clinic.site.url}/#/patients/{clinic.patient}")
    sign_in(page, "onlooker", "not the password")
    assert "wrong" in wait(page, lambda: text(page, "[role=alert]"), "a wrong password is told")
    assert axe.violations(page) == []
    keep(page, "sign-in")
    sign_in(page, "onlooker", PASSWORD)
    wait(page, lambda: clinic.patient in text(page, "main h1"), "the page that was asked for")
    wait(
        page, lambda: page.execute_script("return document.activeElement.tagName") == "H1", "the heading has the focus"
    )
    assert text(page, "nav") == "Sessions\nPatients\nSystem", "only what a viewer may do is offered"
    assert not page.find_element(By.ID, "start").is_displayed(), "a viewer starts nothing"

    page.find_element(By.CSS_SELECTOR, ".account-button").click()
    assert "Viewer" in text(page, ".account-menu")
    assert axe.violations(page) == []
    page.find_element(By.CSS_SELECTOR, ".account-menu button").send_keys(Keys.ESCAPE)
    assert not page.find_element(By.CSS_SELECTOR, ".account-menu").is_displayed()
    page.find_element(By.CSS_SELECTOR, ".account-button").click()
    press(page, "Sign out")
    wait(page, lambda: place(page) == "#/sign-in", "signed out")
    page.get(clinic.site.url)
    wait(page, lambda: place(page) == "#/sign-in", "the cookie is worth nothing any more")
    refusals = [line for line in browsers.complaints(page) if "401" not in line]
    assert refusals == []


def test_whoever_is_signed_out_elsewhere_comes_back_after_signing_in(clinic, page):
    door = enter(clinic.site.url, "onlooker")
    browsers.admit(page, door)
    page.get(f"{clinic.site.url}/#/system")
    wait(page, lambda: text(page, "main h1") == "System", "the page is open")
    enter(clinic.site.url, "onlooker").ask("me/sign-ins", None, "DELETE")
    wait(page, lambda: place(page) == "#/sign-in", "the next answer is that nobody is signed in")
    sign_in(page, "onlooker", PASSWORD)
    wait(page, lambda: text(page, "main h1") == "System", "back again")


def test_an_account_and_a_key_are_made_and_the_key_is_taken_back(clinic, page):
    site = clinic.site
    browsers.admit(page, enter(site.url, "s.lind"))
    page.get(f"{site.url}/#/administration")
    wait(page, lambda: "onlooker" in text(page, "main table"), "the accounts")
    press(page, "New account")
    wait(page, lambda: page.find_elements(By.CSS_SELECTOR, "dialog"), "the form")
    assert axe.violations(page) == []
    fill_in(page, "Name to sign in with", "t.hofer")
    Select(page.find_element(By.CSS_SELECTOR, "dialog select")).select_by_value("therapist")
    press(page, "Create")
    secret = wait(page, lambda: text(page, "dialog .secret"), "the first password")
    keep(page, "first-password")
    press(page, "I have kept it")
    wait(page, lambda: "t.hofer" in text(page, "main table"), "the account is in the list")
    new = Door(site.url)
    assert new.ask("sign-in", {"login": "t.hofer", "password": secret})["role"] == "therapist"

    page.execute_script("location.hash = '#/administration/keys'")
    wait(page, lambda: "hospital export" in text(page, "main table"), "the keys")
    press(page, "Take back hospital export")
    wait(page, lambda: page.find_elements(By.CSS_SELECTOR, "dialog"), "the password is asked for")
    assert axe.violations(page) == []
    fill_in(page, "Your password", "not the password")
    press(page, "Take it back")
    assert "not your password" in wait(page, lambda: text(page, "dialog [role=alert]"), "a wrong one is told")
    fill_in(page, "Your password", PASSWORD)
    press(page, "Take it back")
    wait(page, lambda: "Taken back" in text(page, "main table"), "the key is taken back")
    [key] = [key for key in site.door.ask("keys")["items"] if key["name"] == "hospital export"]
    assert key["revoked"] is not None


def test_the_audit_tells_who_read_what_and_that_it_is_whole(clinic, page):
    clinic.site.door.ask(f"patients/{clinic.patient}")
    browsers.admit(page, clinic.site.door)
    page.get(f"{clinic.site.url}/#/administration/audit")
    wait(page, lambda: text(page, "main tbody"), "entries")
    fill_in(page, "Patient code", clinic.patient)
    fill_in(page, "What", "read patient")
    press(page, "Show")
    rows = "main tbody tr"
    wait(page, lambda: all(clinic.patient in row for row in pages.shown(page, rows)), "only that patient")
    assert "Read patient" in text(page, rows)
    press(page, "Verify the chain")
    wait(page, lambda: "as it was written" in text(page, "main .banner"), "the verdict")
    assert page.find_element(By.CSS_SELECTOR, "main .banner").get_attribute("data-tone") == "good"


def test_a_deleted_patient_is_brought_back_from_the_bin(clinic, page):
    door = clinic.site.door
    code = door.ask("patients", {})["code"]
    door.ask(f"patients/{code}", None, "DELETE")
    browsers.admit(page, door)
    page.get(f"{clinic.site.url}/#/bin")
    wait(page, lambda: code in text(page, "section[aria-label=Patients]"), "the patient is in the bin")
    press(page, f"Bring back {code}")
    wait(page, lambda: f"Patient {code} is back" in text(page, "main [role=status]"), "the patient is back")
    assert door.ask(f"patients/{code}")["code"] == code


def test_the_first_administrator_is_chosen_on_the_page(tmp_path, page):
    port = pages.free_port()
    environment = {"AMBULA_HTTP_PORT": str(port), "AMBULA_DATA_DIR": str(tmp_path), "AMBULA_DATABASE": ""}
    settings = BusSettings(router=f"tcp/127.0.0.1:{pages.free_port()}")
    with Supervisor(["gateway"], settings, environment=environment) as supervisor:
        supervisor.wait_until_ready(timeout_s=180)
        url = f"http://127.0.0.1:{port}"
        Door(url).until_answered(pages.PATIENCE_S)
        code = code_file(tmp_path).read_text().strip()
        page.get(url)
        wait(page, lambda: place(page) == "#/first-run", "nobody has an account yet")
        page.get("about:blank")
        page.get(f"{url}/#/first-run/{code}")
        wait(page, lambda: text(page, "main h1") == "Welcome to Ambula", "the first run")
        assert place(page) == "#/first-run", "the code stays in the history"
        assert axe.violations(page) == []
        keep(page, "first-run")
        fill_in(page, "Name to sign in with", "m.arnold")
        fill_in(page, "Password", PASSWORD)
        fill_in(page, "Password, once more", PASSWORD)
        press(page, "Create the account")
        wait(page, lambda: text(page, "main h1") == "Now", "signed in")
        assert text(page, ".account-button").endswith("m.arnold")
        assert "Administration" in text(page, "nav")
