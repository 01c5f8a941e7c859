"""The router of one machine."""

import pytest

from services.bus.connection import Bus
from services.bus.router import RouterUnavailable, choose_endpoint, open_router
from services.bus.settings import BusSettings


def test_port_zero_takes_a_free_one():
    endpoint = choose_endpoint("tcp/127.0.0.1:0")
    assert endpoint.startswith("tcp/127.0.0.1:")
    assert not endpoint.endswith(":0")
    assert choose_endpoint("tcp/127.0.0.1:7447") == "tcp/127.0.0.1:7447"


def test_a_taken_port_is_an_error_that_says_what_to_do(router):
    with pytest.raises(RouterUnavailable, match=rf"{router.endpoint}.*AMBULA_ROUTER"):
        open_router(BusSettings(router=router.endpoint))


def test_a_port_is_free_again_after_closing():
    router = open_router(BusSettings(router="tcp/127.0.0.1:0"))
    router.close()
    with open_router(BusSettings(router=router.endpoint)) as again:
        Bus.open(BusSettings(router=again.endpoint), "test").close()
