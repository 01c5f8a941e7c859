"""A producer for tests, run as a script: SESSION COUNT RATE_HZ [unruly]. Stays until it is killed."""

import random
import sys
import time

from schemas.signals import stream_key
from services.bus.connection import Bus
from services.bus.replay import RingServer, SharedRing
from services.bus.settings import BusSettings
from services.flow.message import Envelope, encode_payload
from services.flow.ring import ReplayRing
from tests.system.stage import HUB, TICK_NS, FakeIngest, sample


def send_unruly(settings: BusSettings, session: str, count: int, rate_hz: float) -> None:
    """Send in bursts of ten: shuffled, a third twice, a tenth never. The ring has them all, in order."""
    bus = Bus.open(settings, "ingest")
    shared = SharedRing(ReplayRing())
    RingServer.of(bus, HUB.signal).add(session, HUB, shared)
    key = stream_key(settings.site, session, HUB.signal, HUB.source)
    put, _ = bus.publish_cached(key)
    dice = random.Random(7)
    for start in range(0, count, 10):
        burst = []
        for number in range(start, min(start + 10, count)):
            envelope = Envelope(0, number, number * TICK_NS)
            burst.append((encode_payload(sample(number)), envelope.encode()))
            with shared.lock:
                shared.ring.append(envelope, burst[-1][0])
        kept = [one for one in burst if dice.random() >= 0.1]
        kept += dice.sample(kept, len(kept) // 3)
        dice.shuffle(kept)
        for payload, attachment in kept:
            put(payload, attachment)
        time.sleep(10 / rate_hz)


def main() -> None:
    session, count, rate_hz, *mode = sys.argv[1:]
    settings = BusSettings()
    if mode:
        send_unruly(settings, session, int(count), float(rate_hz))
    else:
        ingest = FakeIngest(settings, session)
        ingest.send(int(count), float(rate_hz))
        ingest.end()
    time.sleep(60)


if __name__ == "__main__":
    main()
