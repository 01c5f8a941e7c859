"""Requests as fast as they are asked for, from processes of their own, while somebody watches a session."""

import http.client
import multiprocessing
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

from services.bench.web.site import Site

PROCESSES = 2
CONNECTIONS = 8
"""Of each process: one after the other waits for an answer before it asks again."""


def flood(site: Site, per_s: float, seconds: float) -> Counter[int]:
    """Ask for one's own account at a steady rate; answers by status. Blocks until it is over."""
    context = multiprocessing.get_context("spawn")
    address = site.door.url.removeprefix("http://")
    cookie = "=".join(site.door.cookie)
    share = (address, cookie, per_s / PROCESSES / CONNECTIONS, seconds)
    with context.Pool(PROCESSES) as pool:
        return sum((Counter(each) for each in pool.starmap(_ask_by_many, [share] * PROCESSES)), Counter())


def _ask_by_many(address: str, cookie: str, per_s: float, seconds: float) -> dict[int, int]:
    with ThreadPoolExecutor(CONNECTIONS) as threads:
        asked = [threads.submit(_ask, address, cookie, per_s, seconds) for _ in range(CONNECTIONS)]
        return dict(sum((Counter(each.result()) for each in asked), Counter()))


def _ask(address: str, cookie: str, per_s: float, seconds: float) -> dict[int, int]:
    told: Counter[int] = Counter()
    connection = http.client.HTTPConnection(address, timeout=30)
    begin_s = time.monotonic()
    for number in range(round(per_s * seconds)):
        due_s = begin_s + number / per_s
        if due_s > time.monotonic():
            time.sleep(due_s - time.monotonic())
        if time.monotonic() - begin_s > seconds:
            break
        connection.request("GET", "/v1/me", headers={"Cookie": cookie})
        answer = connection.getresponse()
        answer.read()
        told[answer.status] += 1
    return dict(told)
