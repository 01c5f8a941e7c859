"""The clinic's floor, a running session and the patient's own screen, over real services in a real browser."""

import csv
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

from services.cli import browser as browsers
from services.ingest.synthetic.files import write_recording
from tests.system import pages
from tests.system.pages import begin, keep, live, shown, text, wait

pytestmark = pages.NEEDED

WIDTH, HEIGHT = 1366, 768
LOST = "shank_left"
LOST_FROM_S = 14.0
SETTLED = ("Good", "Wait")

HEARD = """
window.heard = [];
const Line = window.WebSocket;
window.WebSocket = class extends Line {
  constructor(address) {
    super(address);
    this.addEventListener("message", ({ data }) => {
      const message = JSON.parse(data);
      const lost = (message.sensors ?? []).find(({ state }) => state === "missing");
      const shown = () => document.querySelector(".session-head .chip")?.textContent;
      if (lost) setTimeout(() => window.heard.push([message.at_s, lost.since_s, shown()]), 0);
    });
  }
};
"""
"""What each skeleton said of a lost sensor, and what the page then showed."""


@pytest.fixture(scope="module")
def floor(tmp_path_factory: pytest.TempPathFactory) -> Iterator[pages.Site]:
    """A running floor that has at hand a walk in which a sensor falls silent."""
    data = tmp_path_factory.mktemp("data")
    write_recording(data / "falls_silent", "worn=1&seed=2&duration=60&truth=0")
    silence(data / "falls_silent" / f"imu_{LOST}.csv", LOST_FROM_S)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("AMBULA_DATA", str(data))
        with pages.open_site(tmp_path_factory.mktemp("recordings")) as site:
            yield site


def silence(path: Path, from_s: float) -> None:
    """Leave out every row of a sensor's file from a time on."""
    with path.open(newline="") as file:
        head, *rows = list(csv.reader(file))
    with path.open("w", newline="") as file:
        csv.writer(file).writerows([head, *(row for row in rows if float(row[0]) < from_s)])


def lowest(page: Chrome) -> float:
    """Lower edge of the lowest card, px from the top of the page."""
    return float(
        page.execute_script(
            "return Math.max(...[...document.querySelectorAll('.card')].map((card) =>"
            " card.getBoundingClientRect().bottom + window.scrollY))"
        )
    )


def at_once(page: Chrome, selector: str) -> list[str]:
    """Texts of those elements that can be seen, read in one go: cards change places."""
    script = """return [...document.querySelectorAll(arguments[0])].filter((each) => each.checkVisibility())
      .map((each) => each.innerText)"""
    return list(page.execute_script(script, selector))


def test_sixteen_patients_are_on_one_screen_and_each_is_found_by_the_code(site, page):
    codes = [site.door.ask("patients", {})["code"] for _ in range(16)]
    for number, code in enumerate(codes):
        source = ("synthetic:knee?worn=1", "synthetic:walk?worn=1")[number % 2]
        session = begin(site.door, f"{source}&rate=25&truth=0&duration=600&seed={number}")
        site.door.ask(f"sessions/{session}", {"patient": code}, "PATCH")
    page.get(site.url)
    wait(page, lambda: text(page, ".counts").startswith("16 live"), "all sixteen are counted")
    wait(page, lambda: sorted(at_once(page, ".card .who")) == sorted(codes), "each card bears a code")
    assert lowest(page) <= HEIGHT, "sixteen cards fit without scrolling"
    wait(page, lambda: all(told.startswith("last data ") for told in at_once(page, ".card > .quiet")), "all have data")
    wait(page, lambda: set(at_once(page, ".card .light")) <= {*SETTLED, "Delayed"}, "each has a light with a word")
    assert page.find_elements(By.CSS_SELECTOR, ".card .person:not([hidden])") == [], "no name by itself"
    keep(page, "floor")

    site.door.ask(f"patients/{codes[5]}/name", {"name": "Erika Mustermann"}, "PUT")
    page.find_element(By.CSS_SELECTOR, ".names-toggle").click()
    wait(page, lambda: at_once(page, ".card .person") == ["Erika Mustermann"], "a name once it is asked for")
    assert lowest(page) <= HEIGHT
    page.refresh()
    wait(page, lambda: len(at_once(page, ".card")) == 16, "all are there again")
    assert at_once(page, ".card .person") == [], "names are hidden again by themselves"

    wish = page.find_element(By.CSS_SELECTOR, "input[type=search]")
    wish.send_keys(codes[5].lower())
    wait(page, lambda: at_once(page, ".card .who") == [codes[5]], "one is found by the code")
    wish.send_keys(Keys.CONTROL + "a" + Keys.NULL, "extension")
    wait(page, lambda: len(at_once(page, ".card")) == 8, "eight are found by what they do")
    assert lowest(page) <= HEIGHT, "eight roomy cards fit without scrolling"
    assert text(page, ".counts").startswith("16 live"), "the count is of all"
    assert browsers.complaints(page) == []


def test_a_lost_sensor_is_named_at_once_where_it_sits_and_comes_first_on_the_floor(site, page):
    page.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": HEARD})
    others = [begin(site.door, f"synthetic:knee?worn=1&rate=25&truth=0&duration=300&seed={seed}") for seed in (1, 2)]
    session = begin(site.door, "falls_silent")
    page.get(f"{site.url}/#/sessions/{session}")
    wait(page, lambda: text(page, ".session-head .chip") == "Left shank sensor lost", "the state names the sensor")
    at_s, since_s, told = page.execute_script("return heard[0]")
    assert since_s == pytest.approx(LOST_FROM_S, abs=0.02)
    assert at_s - since_s <= 1.0, "seconds of silence before it is said"
    assert told == "Left shank sensor lost", "said as soon as it is heard"
    silent = re.compile(r"^Left shank\nfor \d+ s\nLost$")
    wait(page, lambda: any(map(silent.match, at_once(page, ".sensors li"))), "its line says for how long")
    assert any(re.match(r"Left thigh\n.*Good$", line, re.DOTALL) for line in at_once(page, ".sensors li"))
    dots = page.find_elements(By.CSS_SELECTOR, ".body-map .dot")
    assert sorted(dot.get_attribute("data-tone") for dot in dots) == ["good", "lost"]
    assert "Left shank: Lost" in page.find_element(By.CSS_SELECTOR, ".body-map").get_attribute("aria-label")
    keep(page, "lost-sensor")

    page.get(f"{site.url}/#/")
    wait(page, lambda: len(at_once(page, ".card")) == 1 + len(others), "the floor shows all")
    first = wait(page, lambda: page.find_elements(By.CSS_SELECTOR, ".card:first-child"), "there is a first card")[0]
    assert first.get_attribute("href").endswith(session)
    wait(page, lambda: text(page, ".card:first-child .light") == "Lost", "the light says Lost")
    assert text(page, ".card:first-child .alarm").startswith("Left shank sensor lost")
    wait(page, lambda: "1 needs a look" in text(page, ".counts"), "one is counted as to be looked at")
    assert browsers.complaints(page) == []


def test_the_patient_sees_one_cue_without_numbers_and_a_calm_screen_while_nothing_is_known(site, page):
    session = begin(site.door, "synthetic:walk?worn=1&seed=4&duration=600&truth=0")
    page.get(f"{site.url}/#/sessions/{session}")
    wait(page, lambda: live(page), "the session is live")
    page.find_element(By.TAG_NAME, "body").send_keys("p")
    wait(page, lambda: page.find_element(By.ID, "feedback-cue").is_displayed(), "the cue can be chosen")
    cue = Select(page.find_element(By.ID, "feedback-cue"))
    assert [option.text for option in cue.options] == ["Rhythm of the steps", "Knee bend in swing"]
    cue.select_by_visible_text("Knee bend in swing")
    value = page.find_element(By.ID, "feedback-value")
    value.send_keys(Keys.CONTROL + "a" + Keys.NULL, "85", Keys.TAB)
    address = page.find_element(By.CSS_SELECTOR, ".feedback-dialog a.button").get_attribute("href")
    assert address.endswith(f"#/feedback/{session}?cue=knee&target=85&side=left")

    page.get("about:blank")
    page.get(address)
    sentence = ".feedback-sentence"
    wait(page, lambda: text(page, sentence) == "Bend the left knee more", "the sentence guides")
    assert not re.search(r"\d", page.find_element(By.TAG_NAME, "body").text)
    assert shown(page, "header.top") == [], "nothing around it"
    size = page.find_element(By.CSS_SELECTOR, sentence).value_of_css_property("font-size")
    assert float(size.removesuffix("px")) >= 100, "to be read from four metres"
    keep(page, "feedback")
    page.execute_script(
        "localStorage.setItem('ambula.feedback', JSON.stringify([{session: arguments[0], cue: 'cadence', target: 40,"
        " side: 'left'}])); dispatchEvent(new StorageEvent('storage', {key: 'ambula.feedback'}))",
        session,
    )
    wait(page, lambda: text(page, sentence) == "Calmer steps", "another cue takes its place")

    site.supervisor.kill("gateway")
    wait(page, lambda: text(page, sentence) == "One moment", "it says nothing about what it does not know")
    wait(page, lambda: text(page, sentence) == "Calmer steps", "and comes back by itself")


def test_a_ghost_and_the_keys_of_a_running_session(site, page):
    session = begin(site.door, "synthetic:walk?seed=4&duration=600&truth=0")
    page.get(f"{site.url}/#/sessions/{session}")
    wait(page, lambda: live(page), "the session is live")
    body = page.find_element(By.TAG_NAME, "body")
    body.send_keys("?")
    wait(page, lambda: page.find_element(By.CSS_SELECTOR, "dialog.shortcuts").is_displayed(), "the keys are listed")
    assert "Screen for the patient" in text(page, "dialog.shortcuts dl")
    page.find_element(By.CSS_SELECTOR, "dialog.shortcuts input").click()
    page.find_element(By.CSS_SELECTOR, "dialog.shortcuts button").click()
    ghost = page.find_element(By.CSS_SELECTOR, "select[aria-label=Ghost]")
    body.send_keys("g")
    assert ghost.get_attribute("value") == "off", "single keys have been switched off"
    page.execute_script("localStorage.clear()")
    page.refresh()
    wait(page, lambda: live(page), "the session is live")
    page.find_element(By.TAG_NAME, "body").send_keys("g")
    ghost = page.find_element(By.CSS_SELECTOR, "select[aria-label=Ghost]")
    wait(page, lambda: ghost.get_attribute("value") == "best", "the best stride walks along")
    wait(page, lambda: text(page, ".ghost-key") == "violet: ghost", "the key says what violet is")
    wait(page, lambda: "smaller" in text(page, ".symmetry .quiet"), "steps of both sides are compared")
    wait(page, lambda: " %" in text(page, ".sensors .loss"), "loss is told")
    assert "last 10 s" in text(page, ".sensor-panel .panel-head") or "last 5 s" in text(
        page, ".sensor-panel .panel-head"
    )
    assert browsers.complaints(page) == []
