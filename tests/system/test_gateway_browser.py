"""A person at the page: real services, synthetic walks and exercises, a real browser."""

import time

from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select

from services.cli import browser as browsers
from tests.system import pages
from tests.system.pages import begin, colours, keep, live, part, seen, shown, start, text, wait

pytestmark = pages.NEEDED

KNEE = "Walk, left knee alone"
QUICK = "Five times as fast"
MEASURED = "Curves and numbers"


def numbers(page: Chrome) -> list[str]:
    return [cell.text for cell in page.find_elements(By.CSS_SELECTOR, ".numbers td")]


def test_a_session_started_on_the_page_walks_fills_the_table_and_ends_in_a_report(site, page):
    start(page, site.url)
    wait(page, lambda: text(page, ".session-head .chip") == "Live", "the session is live")
    wait(page, lambda: all(cell != "–" for cell in numbers(page)), "both sides have strides")
    assert len(numbers(page)) == 8

    assert colours(page, ".stage canvas") > 200, "the skeleton's canvas is blank"
    assert all(colours(page, f".chart-panel:nth-child({place}) .chart") > 20 for place in (1, 2))

    seen = set()
    wait(page, lambda: seen.add(text(page, ".chart-panel b.left")) or len(seen) > 5, "the knee moves")
    first = page.find_element(By.CSS_SELECTOR, ".stage canvas").screenshot_as_base64
    wait(
        page,
        lambda: page.find_element(By.CSS_SELECTOR, ".stage canvas").screenshot_as_base64 != first,
        "the skeleton moves",
    )
    sensors = page.find_elements(By.CSS_SELECTOR, ".sensors .chip")
    assert [chip.text for chip in sensors] == ["Good"] * 5
    keep(page, "live")

    page.find_element(By.CSS_SELECTOR, "button.danger").click()
    wait(page, lambda: text(page, ".session-head .chip") == "Finished", "the session ends")
    wait(page, lambda: "m/s" in text(page, ".sheet"), "the report")
    keep(page, "report")
    part(page, MEASURED)
    wait(page, lambda: len(shown(page, ".mean-curves canvas")) == 2, "the mean curves")
    wait(page, lambda: "Walking speed" in text(page, "section[aria-label='Every number']"), "the numbers")
    part(page, "Files")
    wait(page, lambda: "raw" in text(page, ".files"), "the recording can be fetched")

    assert browsers.complaints(page) == []
    assert browsers.hosts_asked(page) == {site.url.removeprefix("http://")}


def test_a_lost_gateway_greys_the_numbers_and_comes_back_by_itself(site, page):
    start(page, site.url)
    wait(page, lambda: text(page, ".session-head .chip") == "Live", "the session is live")
    site.supervisor.kill("gateway")
    wait(page, lambda: text(page, ".session-head .chip").startswith("Delayed ("), "the delay is told")
    assert "stale" in page.find_element(By.CSS_SELECTOR, ".numbers").get_attribute("class")
    assert "stale" in page.find_element(By.CSS_SELECTOR, ".stage").get_attribute("class")
    assert "lost" in text(page, "#connection")
    keep(page, "delayed")
    wait(page, lambda: text(page, ".session-head .chip") == "Live", "live again without a reload")


def test_with_reduced_motion_the_body_is_drawn_on_paper(site):
    with browsers.open_browser(1366, 768, "--force-prefers-reduced-motion") as page:
        browsers.admit(page, site.door)
        start(page, site.url, "Walk, slow", speed=QUICK)
        wait(page, lambda: text(page, ".session-head .chip") == "Live", "the session is live")
        lines = wait(page, lambda: page.find_elements(By.CSS_SELECTOR, ".stage svg line"), "the figure is drawn")
        places = set()
        wait(page, lambda: places.add(lines[-1].get_attribute("y2")) or len(places) > 3, "the figure moves")
        assert page.find_elements(By.CSS_SELECTOR, ".stage canvas") == []
        assert browsers.complaints(page) == []


def test_the_page_of_the_api_works_without_the_internet(site, page):
    page.get(f"{site.url}/docs")
    wait(page, lambda: "/v1/sessions" in text(page, "#api"), "the API is shown")
    time.sleep(1.0)
    keep(page, "docs")
    assert browsers.complaints(page) == []
    assert browsers.hosts_asked(page) == {site.url.removeprefix("http://")}


def test_the_operator_marks_standing_and_is_told_when_it_was_none(site, page):
    """The walker stands for long, is marked, walks off, and is marked again while it walks."""
    session = begin(site.door, "synthetic:walk?standing=25&duration=120&seed=5")
    page.get(f"{site.url}/#/sessions/{session}")
    wait(page, lambda: "walk a few steps" in text(page, ".session-head .chip").lower(), "standing is found")
    time.sleep(3.0)
    page.find_element(By.CSS_SELECTOR, "button.mark").click()
    wait(page, lambda: text(page, ".session-head + .banner") == "Standing taken as marked", "the mark is taken")
    keep(page, "marked")
    wait(page, lambda: text(page, ".session-head .chip") == "Live", "the session is live")
    page.find_element(By.CSS_SELECTOR, "button.mark").click()
    told = wait(page, lambda: notice(page, "Not taken as standing: "), "the mark is refused")
    assert told.endswith(" moved")
    keep(page, "mark-refused")
    wait(page, lambda: text(page, ".session-head + .banner") == "", "the notice goes by itself")
    assert browsers.complaints(page) == []


def notice(page: Chrome, start: str) -> str:
    """The notice at hand if it starts so; read once, since it goes by itself."""
    told = text(page, ".session-head + .banner")
    return told if told.startswith(start) else ""


def test_one_knee_is_one_leg_with_its_angle_and_a_report_of_its_own(site):
    with browsers.open_browser() as page:
        browsers.admit(page, site.door)
        # In real time it is still live after all that is looked at here, however slowly the browser draws.
        pages.start(page, site.url, KNEE)
        wait(page, lambda: live(page), "the session is live")
        seen(page, "output.knee-now.left", 6, "the angle changes")
        seen(page, ".knee-label b", 3, "the angle beside the leg changes")
        wait(page, lambda: page.find_element(By.CSS_SELECTOR, ".knee-facts dd").text != "–", "there is a range")
        assert pages.colours(page, ".stage canvas") > 100, "the leg's canvas is blank"
        first = page.find_element(By.CSS_SELECTOR, ".stage canvas").screenshot_as_base64
        wait(
            page, lambda: page.find_element(By.CSS_SELECTOR, ".stage canvas").screenshot_as_base64 != first, "it moves"
        )
        assert shown(page, ".curves h2") == ["Left knee flexion", "Knee flexion"]
        assert shown(page, ".key b") == ["L left"]
        assert shown(page, ".sensors .chip") == ["Good"] * 2
        wait(page, lambda: "–" not in shown(page, ".numbers td"), "the leg has strides")
        assert shown(page, ".numbers thead th") == ["Last stride", "Left"]
        least, largest, covered = (int(each.rstrip("°").replace("−", "-")) for each in shown(page, ".knee-facts dd"))
        assert least < largest
        assert abs(covered - (largest - least)) <= 1
        keep(page, "knee")

        page.find_element(By.CSS_SELECTOR, "button.danger").click()
        wait(page, lambda: text(page, ".session-head .chip") == "Finished", "the session ends")
        part(page, MEASURED)
        wait(page, lambda: shown(page, ".mean-curves h2") == ["Knee flexion"], "the knee's mean curve alone")
        heads = "section[aria-label='Every number'] thead th"
        wait(page, lambda: shown(page, heads)[:2] == ["Number", "Left"], "that leg's numbers")
        assert "Right" not in shown(page, heads)
        assert shown(page, "section[aria-label='Timed up and go']") == []
        assert browsers.complaints(page) == []


def test_with_reduced_motion_the_leg_is_drawn_on_paper_and_the_task_can_be_chosen(site):
    with browsers.open_browser(1366, 768, "--force-prefers-reduced-motion") as page:
        browsers.admit(page, site.door)
        page.get(f"{site.url}/#/")
        wait(page, lambda: page.find_elements(By.ID, "start"), "the page is there")
        pages.choose_protocol(page)
        assert not page.find_element(By.ID, "walkway").is_displayed()
        page.find_element(By.CSS_SELECTOR, "input[name=task][value=timed_up_and_go]").click()
        walkway = page.find_element(By.ID, "walkway")
        assert walkway.is_displayed()
        walkway.send_keys("3")
        pages.choose_measuring(page, KNEE)
        assert [
            group.get_attribute("label") for group in page.find_elements(By.CSS_SELECTOR, "#estimator optgroup")
        ] == ["Sensors: single knee"]
        Select(page.find_element(By.ID, "speed")).select_by_visible_text(QUICK)
        pages.confirm(page)
        wait(page, lambda: live(page), "the session is live")
        assert page.find_elements(By.CSS_SELECTOR, ".stage canvas") == []
        angle = ".stage .knee-angle[visibility=visible]"
        seen(page, angle, 4, "the angle beside the leg changes")
        # Floor, thigh, shank and foot: of the other leg, the pelvis and the trunk there is nothing.
        assert len(page.find_elements(By.CSS_SELECTOR, ".stage line:not([visibility=hidden])")) == 4
        assert len(shown(page, ".strip .parts li")) == 5
        assert shown(page, ".strip h2") == ["Timed up and go"]
        keep(page, "knee-paper")
        assert browsers.complaints(page) == []


def test_a_timed_test_is_reported_by_its_parts_and_an_exercise_by_its_repetitions(site, page):
    timed = begin(site.door, "synthetic:tug?worn=2&seed=4&pause=3", speed=None)
    exercise = begin(site.door, "synthetic:knee?duration=30&seed=2", speed=None)
    page.get(f"{site.url}/#/sessions/{timed}")
    wait(page, lambda: text(page, ".session-head .chip") == "Finished", "the timed test ends")
    part(page, MEASURED)
    drawing = "section[aria-label='Timed up and go'] svg"
    wait(page, lambda: page.find_elements(By.CSS_SELECTOR, f"{drawing} rect"), "the bar is drawn")
    assert len(page.find_elements(By.CSS_SELECTOR, f"{drawing} rect")) == 5
    told = page.find_element(By.CSS_SELECTOR, drawing).get_attribute("aria-label")
    assert told.startswith("Attempt 1: Stand up ")
    assert "in all" in told
    assert shown(page, "section[aria-label='Timed up and go'] tbody th") == ["Attempt 1"]

    page.get(f"{site.url}/#/sessions/{exercise}/curves")
    wait(page, lambda: text(page, ".session-head .chip") == "Finished", "the exercise ends")
    bars = "section[aria-label=Repetitions] svg rect"
    wait(page, lambda: len(page.find_elements(By.CSS_SELECTOR, bars)) > 3, "the repetitions are drawn")
    rows = page.find_elements(By.CSS_SELECTOR, "section[aria-label=Repetitions] tbody tr")
    assert len(rows) == len(page.find_elements(By.CSS_SELECTOR, bars))
    wait(page, lambda: "Peak flexion" in text(page, "section[aria-label='Every number']"), "the numbers")
    assert shown(page, ".mean-curves") == []
    assert browsers.complaints(page) == []


def test_swapped_sensors_are_named_live_and_in_the_report(site, page):
    swapped = begin(site.door, "synthetic:walk?worn=1&misworn=1&duration=40&seed=4", speed=4.0)
    page.get(f"{site.url}/#/sessions/{swapped}")
    wait(page, lambda: "swapped" in text(page, ".session-head .chip"), "the chip names the swap")
    assert shown(page, "output.knee-now") in ([], ["–"])
    wait(page, lambda: text(page, ".session-head .chip") == "Finished", "the session ends")
    wait(page, lambda: "Thigh and shank sensor of the left leg" in text(page, "main"), "the report names it")
    assert browsers.complaints(page) == []
