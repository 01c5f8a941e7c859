"""A session that is over, at a real page: its replay plays, is scrubbed and sought by strides, and agrees with REST."""

import re
from http import HTTPStatus
from urllib.error import HTTPError

from selenium.webdriver import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

from services.cli import browser as browsers
from tests.system import axe, pages
from tests.system.pages import begin, colours, keep, part, shown, text, wait

pytestmark = pages.NEEDED

WALK = "synthetic:walk?duration=25&seed=3"
STAGE = ".stage canvas"


def now_s(page) -> float:
    """Where the replay is, s."""
    slider = page.find_element(By.CSS_SELECTOR, "[role=slider]")
    return float(slider.get_attribute("aria-valuenow"))


def picture(page) -> str:
    return page.find_element(By.CSS_SELECTOR, STAGE).screenshot_as_base64


def is_closed(door, session) -> bool:
    """The archive has closed the files of a session; until then a page asks again by itself."""
    try:
        door.ask(f"sessions/{session}/recorded")
    except HTTPError as error:
        if error.code == HTTPStatus.CONFLICT:
            return False
        raise
    return True


def run(page, site) -> str:
    """A walk, as fast as it goes, to its end."""
    session = begin(site.door, WALK, speed=None)
    wait(page, lambda: is_closed(site.door, session), "the session is over and its files are closed")
    return session


def test_a_replay_plays_is_scrubbed_and_goes_to_a_stride_and_back(site, page):
    session = run(page, site)
    page.get(f"{site.url}/#/sessions/{session}")
    wait(page, lambda: text(page, ".session-head .chip") == "Finished", "the session is over")
    part(page, "Replay")
    wait(page, lambda: page.find_elements(By.CSS_SELECTOR, ".look-left"), "the strides are on the timeline")
    page.find_element(By.CSS_SELECTOR, "[role=slider]").send_keys(Keys.HOME, *[Keys.PAGE_DOWN] * 1)
    wait(page, lambda: now_s(page) == 10.0 and colours(page, STAGE) > 200, "the figure stands there at ten seconds")
    before = picture(page)
    # Slow, so that a busy machine does not come to the end meanwhile.
    Select(page.find_element(By.CSS_SELECTOR, "[aria-label=Speed]")).select_by_visible_text("0.25×")
    page.find_element(By.TAG_NAME, "body").send_keys(Keys.SPACE)
    wait(page, lambda: now_s(page) > 10.3, "it plays")
    wait(page, lambda: picture(page) != before, "the figure moves")
    wait(page, lambda: colours(page, ".chart-panel .chart") > 20, "so do the curves")
    keep(page, "replay")
    page.find_element(By.XPATH, "//button[.='Pause']").click()
    paused_s = now_s(page)
    assert page.current_url.endswith(f"/replay?t={paused_s:.2f}")

    slider = page.find_element(By.CSS_SELECTOR, "[role=slider]")
    slider.send_keys(Keys.ARROW_RIGHT)
    assert 0.0 < now_s(page) - paused_s < 0.07, "an arrow is one picture"
    ActionChains(page).move_to_element_with_offset(slider, slider.size["width"] // 4, 0).click().perform()
    assert 15.0 < now_s(page) < 22.0, "where the pointer is"
    wait(page, lambda: "°" in text(page, ".chart-panel b.left"), "the number at the cursor")

    strides = site.door.ask(f"sessions/{session}/strides?limit=500")
    starts = sorted(each["start_s"] for each in strides["items"])
    here = now_s(page)
    slider.send_keys(Keys.ARROW_UP)
    assert abs(now_s(page) - max(each for each in starts if each < here)) < 0.02, "an arrow up is a stride back"

    assert axe.violations(page) == []
    link = page.find_element(By.LINK_TEXT, "In the table")
    link.click()
    wait(page, lambda: len(page.find_elements(By.CSS_SELECTOR, "tr[aria-current]")) == 1, "its row is shown")
    assert browsers.complaints(page) == []


def test_the_table_of_strides_is_that_of_rest_and_leads_to_their_moments(site, page):
    session = run(page, site)
    page.get(f"{site.url}/#/sessions/{session}/strides")
    wait(page, lambda: page.find_elements(By.CSS_SELECTOR, ".strides-panel tbody tr"), "the strides are there")
    told = site.door.ask(f"sessions/{session}/strides")["items"]
    assert len(told) > 20
    rows = page.find_elements(By.CSS_SELECTOR, ".strides-panel tbody tr")
    assert [row.find_element(By.TAG_NAME, "th").text for row in rows] == [
        f"{each['side'][0].upper()} {each['index'] + 1}" for each in told
    ]
    assert [row.find_elements(By.TAG_NAME, "td")[2].text for row in rows] == [f"{s['stride_time_s']:.2f}" for s in told]
    refused = [each["rejected_because"] for each in told if not each["valid"]]
    hollow = page.find_elements(By.CSS_SELECTOR, ".strides-panel tr.refused td:last-child")
    assert [cell.text for cell in hollow] == refused

    assert axe.violations(page) == []
    place = len(told) // 2
    rows[place].find_element(By.TAG_NAME, "a").click()
    wait(page, lambda: page.find_elements(By.CSS_SELECTOR, "[role=slider]"), "the replay opens")
    wait(page, lambda: abs(now_s(page) - told[place]["start_s"]) < 0.02, "at that stride")
    page.back()
    wait(page, lambda: shown(page, ".strides-panel tbody th"), "and back")

    part(page, "Versions")
    wait(page, lambda: "shown everywhere" in text(page, ".part"), "which software computed it")
    assert re.search(r"ambula \d", text(page, ".part h2"))
    assert axe.violations(page) == []
    assert browsers.complaints(page) == []
    assert browsers.hosts_asked(page) == {site.url.removeprefix("http://")}
