"""A therapist looks for patients, registers one by name, shares one with a colleague and puts one into the bin."""

from collections.abc import Iterator

import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from services.cli import browser as browsers
from services.cli.door import Door
from tests.system import pages
from tests.system.pages import keep, text, wait
from tests.system.visits import seed_visits

pytestmark = pages.NEEDED

ROWS = ".paged-list tbody tr"
NAME = "Zoe Okafor-Lindqvist"


@pytest.fixture(scope="module")
def clinic(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Door, str]]:
    """The door of a gateway alone, and the code of a patient who came twice."""
    data = tmp_path_factory.mktemp("patients")
    code, _ = seed_visits(data, [0.52, 0.74], ["cane", "cane"])
    with pages.open_site(data, ["gateway"]) as site:
        site.door.ask(f"patients/{code}/progress")
        yield site.door, code


@pytest.fixture
def patients(clinic: tuple[Door, str], page: Chrome) -> Iterator[Chrome]:
    """The list of patients."""
    door, _ = clinic
    browsers.admit(page, door)
    page.get(f"{door.url}/#/patients")
    wait(page, lambda: page.find_elements(By.CSS_SELECTOR, ROWS), "patients are listed")
    yield page
    assert browsers.complaints(page) == []
    assert browsers.hosts_asked(page) == {door.url.removeprefix("http://")}


def button(page: Chrome, words: str) -> None:
    page.find_element(By.XPATH, f"//button[starts-with(normalize-space(), '{words}')]").click()


def rows(page: Chrome) -> list[str]:
    return [each.text for each in page.find_elements(By.CSS_SELECTOR, ROWS)]


def test_the_list_tells_visits_and_a_verdict_and_a_name_only_when_asked(
    clinic: tuple[Door, str], patients: Chrome
) -> None:
    page, (door, code) = patients, clinic
    wait(page, lambda: "real change, for the better" in text(page, ROWS), "the verdict")
    assert "Stroke, chronic" in text(page, ROWS)

    button(page, "New patient")
    page.find_element(By.ID, "new-year-of-birth").send_keys("1961")
    page.find_element(By.ID, "new-name").send_keys(NAME, Keys.ENTER)
    wait(page, lambda: "#/patients/" in page.current_url, "the page of the new patient")
    new = page.current_url.rsplit("/", 1)[-1]
    wait(page, lambda: text(page, "h1") == f"Patient {new}", "its heading")
    assert NAME not in text(page, "main")
    button(page, "Show name")
    wait(page, lambda: NAME in text(page, ".identity"), "the name")
    assert door.ask(f"patients/{new}")["year_of_birth"] == 1961

    page.get(f"{door.url}/#/patients")
    wait(page, lambda: len(rows(page)) == 2, "both are listed")
    assert NAME not in text(page, "main")
    button(page, "Show names")
    wait(page, lambda: NAME in text(page, "main"), "the name beside the code")
    keep(page, "patients-named")
    button(page, "Hide names")
    wait(page, lambda: NAME not in text(page, "main"), "codes alone again")

    search = page.find_element(By.CSS_SELECTOR, "input[type=search]")
    search.send_keys("okafor")
    wait(page, lambda: len(rows(page)) == 1 and new in rows(page)[0], "found by name")
    search.clear()
    search.send_keys(code[1:5].lower())
    wait(page, lambda: len(rows(page)) == 1 and code in rows(page)[0], "found by code")


def test_a_patient_s_page_shows_the_reference_shares_and_puts_away(clinic: tuple[Door, str], patients: Chrome) -> None:
    page, (door, code) = patients, clinic
    door.ask("clinics", {"id": "north", "name": "North"})
    door.ask("accounts", {"login": "m.north", "role": "therapist", "password": "three quiet steps", "clinic": "north"})
    # A reference set that ships is of men of that age.
    door.ask(f"patients/{code}", {"sex": "male", "year_of_birth": 1981}, "PATCH")
    page.get(f"{door.url}/#/patients/{code}")
    measure = "figure[data-measure=walking_speed]"
    wait(page, lambda: "real change" in text(page, measure), "progress")
    assert text(page, f"{measure} .reference").startswith("Reference ")
    assert page.find_elements(By.CSS_SELECTOR, f"{measure} svg .reference-band")
    keep(page, "patient-page")

    shares = "section[aria-label='Shared with']"
    wait(page, lambda: "Nobody outside" in text(page, shares), "not shared yet")
    page.find_element(By.CSS_SELECTOR, f"{shares} input").send_keys("nobody.here", Keys.ENTER)
    wait(page, lambda: text(page, f"{shares} .banner") != "", "there is no such colleague")
    login = page.find_element(By.CSS_SELECTOR, f"{shares} input")
    login.clear()
    login.send_keys("m.north", Keys.ENTER)
    wait(page, lambda: "m.north" in text(page, f"{shares} li"), "shared")
    assert [each["login"] for each in door.ask(f"patients/{code}/shares")["items"]] == ["m.north"]
    # The answer of 404 is what the page was told, not a fault of it.
    assert len(browsers.complaints(page)) == 1

    button(page, "Into the bin")
    page.find_element(By.CSS_SELECTOR, "dialog button[type=submit]").click()
    wait(page, lambda: page.current_url.endswith("#/patients"), "back to the list")
    wait(page, lambda: page.find_elements(By.CSS_SELECTOR, ROWS) and code not in text(page, "main"), "it is gone")
    assert [each["code"] for each in door.ask("bin")["patients"]] == [code]
