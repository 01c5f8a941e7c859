"""What browsers hold: renewed, copied, forgotten, ended, and never more than a few."""

import asyncio
from http import HTTPStatus

import pytest
from fastapi.testclient import TestClient

from services.gateway import app as application
from services.gateway.access import sign_ins
from services.gateway.access.identify import COOKIE
from services.gateway.access.roles import Role
from services.gateway.accounts.housekeeping import forget_expired_sign_ins
from services.gateway.housekeeping import keep_house
from services.gateway.live import routes
from services.gateway.live.hub import LiveHub
from services.gateway.parameters import GatewayParameters
from tests.unit.gateway import people
from tests.unit.gateway.accounts.conftest import hold

GRACE = 61
IN, OUT = HTTPStatus.OK, HTTPStatus.UNAUTHORIZED


def renew(browser):
    """Renew; the cookies before and after."""
    before = browser.cookies[COOKIE]
    answer = browser.post("/v1/sign-in/renewal")
    assert answer.status_code == HTTPStatus.OK
    return before, browser.cookies[COOKIE]


def holding(clinic, cookie):
    browser = clinic.browser()
    hold(browser, cookie)
    return browser


def asks(browser):
    return browser.get("/v1/me").status_code


def test_a_renewal_changes_the_secret_and_requests_under_way_still_arrive(clinic):
    browser = clinic.browser(Role.THERAPIST)
    before, after = renew(browser)
    assert before.split(".")[0] == after.split(".")[0]
    assert before != after
    assert [asks(holding(clinic, cookie)) for cookie in (before, after)] == [IN, IN]


def test_an_old_secret_ends_the_sign_in_for_thief_and_owner_and_is_in_the_audit(clinic):
    browser = clinic.browser(Role.THERAPIST)
    stolen, kept = renew(browser)
    clinic.age_sign_ins(renewed=GRACE)
    assert asks(browser) == IN
    assert asks(holding(clinic, stolen)) == OUT
    assert asks(holding(clinic, kept)) == OUT
    entry = clinic.audit()[-1]
    assert (entry.action, entry.object, entry.clinic) == (
        "old_sign_in_secret",
        f"account={browser.account}",
        "main",
    )
    assert stolen.split(".")[1] not in str(vars(entry))


def test_a_thief_who_renews_is_found_out_however_often(clinic):
    owner = clinic.browser(Role.THERAPIST)
    thief = holding(clinic, owner.cookies[COOKIE])
    for _ in range(3):
        renew(thief)
        clinic.age_sign_ins(renewed=GRACE)
    assert asks(owner) == OUT
    assert asks(thief) == OUT


def test_a_made_up_secret_for_a_known_id_ends_it_too(clinic):
    browser = clinic.browser(Role.THERAPIST)
    name = browser.cookies[COOKIE].split(".")[0]
    assert asks(holding(clinic, f"{name}.{'x' * 43}")) == OUT
    assert asks(browser) == OUT


def test_tabs_that_renew_at_once_stay_signed_in(clinic):
    one = clinic.browser(Role.THERAPIST)
    other = holding(clinic, one.cookies[COOKIE])
    _, newest = renew(one)
    # The second tab still had the old cookie when it asked; the browser's jar keeps the newest.
    before, after = renew(other)
    assert before == after
    assert renew(one) == (newest, newest)
    clinic.age_sign_ins(renewed=GRACE)
    assert asks(one) == IN


def test_a_cookie_that_is_none_is_nobody(clinic):
    for cookie in ("", ".", "a", "a.b", "no-id.no-secret", "..", "a" * 5000):
        assert asks(holding(clinic, cookie)) == OUT, cookie


@pytest.mark.parametrize(("age", "expected"), [("seen", 3601), ("created", 12 * 3600 + 1)])
def test_a_sign_in_ends_by_itself_and_is_removed(clinic, age, expected):
    browser, gateway = clinic.browser(Role.THERAPIST), clinic.gateway
    clinic.age_sign_ins(**{age: expected - 60})
    assert forget_expired_sign_ins(gateway.database, gateway.parameters) == 0
    assert asks(browser) == IN
    clinic.age_sign_ins(**{age: expected})
    assert asks(browser) == OUT
    assert forget_expired_sign_ins(gateway.database, gateway.parameters) == 1
    assert clinic.sign_ins() == []


def test_an_account_is_signed_in_to_by_a_bounded_number_of_browsers(clinic):
    first = clinic.browser(Role.THERAPIST)
    clinic.age_sign_ins(seen=120)
    second = clinic.browser(Role.THERAPIST)
    others = [clinic.browser(Role.THERAPIST) for _ in range(sign_ins.MOST - 1)]
    stranger = clinic.browser(Role.VIEWER)
    assert asks(first) == OUT
    assert {asks(browser) for browser in (second, others[-1], stranger)} == {IN}
    assert len(clinic.sign_ins()) == sign_ins.MOST + 1


def test_the_house_is_kept_while_the_gateway_runs(monkeypatch, settings, hub, control):
    done = []

    async def once(jobs):
        done.extend(jobs)

    monkeypatch.setattr(application, "keep_house", once)
    with TestClient(application.create_app(settings, hub, control)) as client:
        client.get("/v1/sign-in")
    assert "sign_ins" in done


def test_a_job_that_fails_does_not_keep_the_others_from_theirs(caplog):
    done = []

    async def keep_for_a_while():
        house = asyncio.create_task(keep_house({"bad": lambda: 1 / 0, "good": lambda: done.append(1)}, every_s=0.0))
        while len(done) < 2:
            await asyncio.sleep(0)
        house.cancel()

    asyncio.run(keep_for_a_while())
    assert "housekeeping_failed" in caplog.text


class TestLive:
    """A connection that stays open has the cookie it was opened with."""

    @pytest.fixture
    def hub(self):
        return LiveHub(GatewayParameters(ask_again_s=0.02, floor_interval_s=0.02))

    def test_it_outlasts_renewals_and_ends_with_the_sign_in(self, stranger, clinic, monkeypatch):
        people.sign_in(stranger, Role.THERAPIST)
        hold(stranger, stranger.cookies[COOKIE])
        asked = []
        identify_again = routes.identify_again
        monkeypatch.setattr(routes, "identify_again", lambda socket: asked.append(1) or identify_again(socket))
        with stranger.websocket_connect("/v1/live") as socket:
            for _ in range(2):
                renew(stranger)
                clinic.age_sign_ins(renewed=GRACE)
            asked.clear()
            while len(asked) < 3:
                socket.receive_json()
            assert asks(stranger) == IN
            assert stranger.post("/v1/sign-out").status_code == HTTPStatus.NO_CONTENT
            message = socket.receive()
            while message["type"] != "websocket.close":
                message = socket.receive()
            assert message["code"] == 4401
