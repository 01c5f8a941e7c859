"""A person at the page of somebody before a depth camera: real services, synthetic exercises, a real browser."""

from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By

from services.cli import browser as browsers
from tests.system import pages
from tests.system.pages import begin, colours, keep, live, seen, shown, text, wait

pytestmark = pages.NEEDED


def reasons(page) -> str:
    unseen = page.find_elements(By.CSS_SELECTOR, ".angles td.unseen-angle")
    return " ".join(each.get_attribute("title") or "" for each in unseen)


SQUATS = "synthetic:squat?person=2&noise=0.3&repetitions=200"


def test_squats_before_a_camera_are_seen_counted_and_reported_on_both_sides(site, page):
    session = begin(site.door, SQUATS)
    page.get(f"{site.url}/#/sessions/{session}")
    wait(page, lambda: live(page), "the session is live")
    wait(page, lambda: shown(page, ".camera-chips .chip") == ["Good"], "the camera's state is told")
    assert shown(page, ".curves h2") == ["Knee flexion", "Hip flexion", "Arm elevation"]
    wait(page, lambda: colours(page, ".stage canvas") > 200, "the body's canvas is not blank")
    first = page.find_element(By.CSS_SELECTOR, ".stage canvas").screenshot_as_base64
    wait(page, lambda: page.find_element(By.CSS_SELECTOR, ".stage canvas").screenshot_as_base64 != first, "it moves")
    seen(page, ".angles td", 6, "the angles change")
    # In the first seconds every angle is unseen, for another reason than straight knees.
    wait(page, lambda: "knee is bent" in reasons(page), "straight knees hide the rotation, and it says why")
    wait(page, lambda: int(text(page, "output.count")) >= 3, "squats are counted")
    wait(page, lambda: all("°" in each for each in shown(page, ".side-bar b")), "both knees are compared")
    keep(page, "squat")

    page.find_element(By.CSS_SELECTOR, "button.danger").click()
    wait(page, lambda: text(page, ".session-head .chip") == "Finished", "the session ends")
    pages.part(page, "Curves and numbers")
    bars = "section[aria-label=Repetitions] svg rect"
    wait(page, lambda: len(page.find_elements(By.CSS_SELECTOR, bars)) >= 3, "the repetitions are drawn")
    rows = page.find_elements(By.CSS_SELECTOR, "section[aria-label=Repetitions] tbody tr")
    assert len(rows) == len(page.find_elements(By.CSS_SELECTOR, bars))
    numbers = "section[aria-label='Every number']"
    wait(page, lambda: "Hip flexion range" in text(page, numbers), "the numbers")
    assert shown(page, f"{numbers} thead th") == ["Number", "Left", "Right", "Whole body"]
    assert shown(page, ".mean-curves") == []
    keep(page, "squat-report")
    assert browsers.complaints(page) == []


def test_who_walks_out_of_the_camera_s_view_is_not_drawn_on_paper_either(site):
    with browsers.open_browser(1366, 768, "--force-prefers-reduced-motion") as page:
        browsers.admit(page, site.door)
        page.get(f"{site.url}/#/")
        wait(page, lambda: page.find_elements(By.ID, "start"), "the page is there")
        pages.choose_source(page, "Leaning forward, camera", task="Squat")
        assert [
            group.get_attribute("label") for group in page.find_elements(By.CSS_SELECTOR, "#estimator optgroup")
        ] == ["Camera: whole body"]
        sources = page.find_element(By.ID, "source").text
        assert "Squats with the arms raised, camera" in sources
        assert "Timed up and go" not in sources
        assert not page.find_element(By.ID, "walk-path").is_displayed()
        away = begin(site.door, "synthetic:tilt_forward?person=2&noise=0.3&repetitions=200&away_at=30&away_for=600")
        page.get(f"{site.url}/#/sessions/{away}")
        wait(page, lambda: live(page), "the session is live")
        head = ".stage svg circle"
        places = set()
        wait(page, lambda: places.add(attribute(page, head, "cy")) or len(places) > 3, "the body is drawn and moves")
        assert page.find_elements(By.CSS_SELECTOR, ".stage canvas") == []
        keep(page, "tilt-paper")
        wait(page, lambda: text(page, ".session-head .chip") == "Nobody in view", "the way out is told")
        assert shown(page, ".camera-chips .chip") == ["Nobody in view"]
        # For a moment the filter goes on by itself.
        wait(page, lambda: attribute(page, ".stage svg g", "display") == "none", "nobody is drawn")
        wait(page, lambda: "°" not in text(page, ".angles tbody"), "no angle is shown")
        assert browsers.complaints(page) == []


def attribute(page: Chrome, selector: str, name: str) -> str | None:
    return page.find_element(By.CSS_SELECTOR, selector).get_attribute(name)
