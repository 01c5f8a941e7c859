"""A therapist looks back: a patient's visits, whether the change is real, the report in both languages, its PDF."""

from collections.abc import Iterator

import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from services.cli import browser as browsers
from services.cli.door import Door
from tests.system import pages
from tests.system.pages import keep, read, shown, text, wait
from tests.system.visits import seed_visits

pytestmark = pages.NEEDED

SPEEDS = [0.52, 0.60, 0.74]
AIDS = ["cane", "rollator", "cane"]


@pytest.fixture(scope="module")
def clinic(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Door, str]]:
    """The door of a gateway alone, and the code of a patient who came three times."""
    data = tmp_path_factory.mktemp("visits")
    code, _ = seed_visits(data, SPEEDS, AIDS)
    with pages.open_site(data, ["gateway"]) as site:
        yield site.door, code


def test_a_patient_s_visits_give_a_verdict_with_its_rule_and_a_report_in_two_languages(
    clinic: tuple[Door, str], page: Chrome
) -> None:
    door, code = clinic
    url = door.url
    browsers.admit(page, door)
    page.get(f"{url}/#/patients")
    wait(page, lambda: page.find_elements(By.LINK_TEXT, code), "the patient is listed")
    page.find_element(By.LINK_TEXT, code).click()

    speed = "figure[data-measure=walking_speed]"
    wait(page, lambda: "real change, for the better" in text(page, speed), "the verdict")
    assert "larger than the MDC of 0.15 m/s" in text(page, speed)
    assert "Lewek 2019" in text(page, speed)
    wait(page, lambda: len(page.find_elements(By.CSS_SELECTOR, f"{speed} svg polygon")) == 1, "one triangle")
    progress = text(page, "section[aria-label=Progress]")
    assert "Visit 2: Not like with like: walking aid rollator now, cane at the baseline." in progress
    assert "speaks for recovery" in text(page, "section[aria-label='Recovery or compensation']")
    assert "normal" not in text(page, "main").lower()
    keep(page, "patient")

    wait(page, lambda: len(page.find_elements(By.LINK_TEXT, "Report")) == len(SPEEDS), "the visits are listed")
    page.find_elements(By.LINK_TEXT, "Report")[0].click()
    wait(page, lambda: "0.74 m/s" in text(page, ".sheet[lang=en]"), "the report in English")
    keep(page, "report-english")
    assert begins(page, door) == b"%PDF"

    # The languages are one row of choices for the keyboard, too.
    page.find_element(By.CSS_SELECTOR, "input[name=report-language]:checked").send_keys(Keys.ARROW_RIGHT)
    wait(page, lambda: "0,74 m/s" in text(page, ".sheet[lang=fr]"), "the report in French")
    assert begins(page, door) == b"%PDF"
    read(page, "Pour les spécialistes")
    limits = ".sheet[lang=fr] section[data-section=limits]"
    wait(page, lambda: text(page, limits) != "", "what the report can not tell")
    page.refresh()
    wait(page, lambda: text(page, limits) != "", "language and level are remembered")
    assert shown(page, ".sheet tbody th[scope=row]") != []
    keep(page, "report-french")

    assert browsers.complaints(page) == []
    assert browsers.hosts_asked(page) == {url.removeprefix("http://")}


def begins(page: Chrome, door: Door) -> bytes:
    """The first bytes of the report's PDF, asked for at the address that the page offers."""
    address = page.find_element(By.CSS_SELECTOR, ".report-bar a[download]").get_attribute("href")
    assert address is not None
    return door.read(address.removeprefix(f"{door.url}/v1/"))[:4]
