"""A therapist starts a session step by step, by keyboard alone, and sees how well the sensors' places were found."""

from collections.abc import Iterator

import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from services.cli import browser as browsers
from services.cli.door import Door
from tests.system import pages
from tests.system.pages import keep, onward, shown, text, wait

pytestmark = pages.NEEDED

STEP = ".start-step h2"


def press(page: Chrome, *keys: str) -> None:
    """Keys to whatever has the focus."""
    ActionChains(page).send_keys(*keys).perform()


def register(door: Door) -> str:
    return str(door.ask("patients", {"year_of_birth": 1961, "paretic_side": "right"})["code"])


@pytest.fixture
def opened(site: pages.Site, page: Chrome) -> Iterator[Chrome]:
    page.get(f"{site.url}/#/start")
    wait(page, lambda: text(page, STEP) == "Whose session is it?", "the first step")
    yield page
    assert browsers.complaints(page) == []
    assert browsers.hosts_asked(page) == {site.url.removeprefix("http://")}


def test_a_session_is_started_by_keyboard_alone_and_its_calibration_is_told(site: pages.Site, opened: Chrome) -> None:
    page, code = opened, register(site.door)
    page.find_element(By.CSS_SELECTOR, "input[value=later]").send_keys(Keys.ARROW_RIGHT)
    press(page, Keys.TAB, code[:4].lower())
    wait(page, lambda: code in text(page, ".found"), "the patient is found by part of the code")
    press(page, Keys.TAB, Keys.SPACE, Keys.ENTER)
    wait(page, lambda: text(page, STEP) == "What will be done?", "the protocol")
    assert page.switch_to.active_element.text == "What will be done?"

    press(page, Keys.TAB, Keys.TAB)
    page.find_element(By.CSS_SELECTOR, "input[name=task]:checked").send_keys(Keys.ARROW_DOWN)
    assert "comfortable pace" in text(page, ".about")
    press(page, Keys.ENTER)
    wait(page, lambda: text(page, STEP) == "What measures?", "the sensors")
    wait(page, lambda: "Walk, comfortable speed" in text(page, "#source"), "the sources are offered")
    page.find_element(By.ID, "source").send_keys("Walk, comf")
    wait(page, lambda: "Sensors: pelvis and both legs" in text(page, ".start-step"), "a walk is chosen")
    assert "Pelvis: at the back, on the belt line" in text(page, ".placement")
    keep(page, "start-sensors")
    page.find_element(By.ID, "speed").send_keys("Twice")
    page.find_element(By.CSS_SELECTOR, ".start-step button[type=submit]").send_keys(Keys.ENTER)

    wait(page, lambda: text(page, STEP) == "Calibration", "the session has begun")
    wait(page, lambda: text(page, ".duty-head") == "Ready", "the sensors' places are found")
    facts = text(page, ".facts-list")
    assert "quiet standing" in facts
    assert "absolute" in facts
    assert shown(page, ".worn-list .chip") == ["Good"] * 5
    keep(page, "start-ready")
    press(page, Keys.ENTER)
    wait(page, lambda: "#/sessions/" in page.current_url, "the live page")
    session = page.current_url.rsplit("/", 1)[-1]
    begun = site.door.ask(f"sessions/{session}")
    assert (begun["patient"], begun["task"], begun["conditions"]["paretic_side"]) == (code, "walk", "right")


def test_one_can_go_back_and_what_is_wrong_stands_beside_its_field(site: pages.Site, opened: Chrome) -> None:
    page = opened
    page.find_element(By.CSS_SELECTOR, "input[value=known]").click()
    page.find_element(By.CSS_SELECTOR, ".start-step button[type=submit]").click()
    wait(page, lambda: "Choose a patient" in text(page, "#patient-search-wrong"), "somebody has to be chosen")
    assert page.switch_to.active_element.get_attribute("id") == "patient-search"
    page.find_element(By.CSS_SELECTOR, "input[value=new]").click()
    year = page.find_element(By.ID, "new-year-of-birth")
    year.send_keys("1492", Keys.ENTER)
    wait(page, lambda: "1900" in text(page, "#new-year-of-birth-wrong"), "the year is refused")
    assert year.get_attribute("aria-invalid") == "true"
    year.clear()
    year.send_keys("1961")
    onward(page, "What will be done?")
    code = text(page, ".steps li:first-child .quiet")
    assert site.door.ask(f"patients/{code}")["year_of_birth"] == 1961

    page.find_element(By.CSS_SELECTOR, "input[name=task][value=ten_metre_walk]").click()
    page.find_element(By.ID, "timed-from").send_keys("8")
    page.find_element(By.ID, "timed-to").send_keys("2", Keys.ENTER)
    wait(page, lambda: "ends after it begins" in text(page, "#timed-to-wrong"), "the timed part is refused")
    page.back()
    wait(page, lambda: text(page, STEP) == "Whose session is it?", "the browser goes back a step")
    assert page.find_element(By.CSS_SELECTOR, f"input[name=patient][value='{code}']").is_selected()
    onward(page, "What will be done?")
    assert page.find_element(By.ID, "timed-from").get_attribute("value") == "8"
    assert site.door.ask("sessions?state=live")["items"] == []


def test_calibration_shows_that_standing_is_seen_takes_a_mark_and_may_be_skipped(
    site: pages.Site, page: Chrome
) -> None:
    session = pages.begin(site.door, "synthetic:walk?standing=30&duration=120&seed=5")
    page.get(f"{site.url}/#/start/session/{session}")
    wait(page, lambda: text(page, ".duty-head") == "Walk a few steps", "standing was seen")
    wait(page, lambda: page.find_element(By.CSS_SELECTOR, ".stood progress").get_attribute("value") == "1", "all of it")
    page.find_element(By.CSS_SELECTOR, "button.mark").click()
    wait(page, lambda: "Standing taken as marked" in text(page, ".duty"), "the mark is taken")
    assert "It may be skipped" in text(page, ".duty")
    skip = page.find_element(By.CSS_SELECTOR, ".start-step button[type=submit]")
    assert skip.text == "Skip calibration"
    skip.click()
    wait(page, lambda: f"#/sessions/{session}" in page.current_url, "the live page")
    assert browsers.complaints(page) == []
