"""A consumer for tests, run as a script: SESSION FILE. Appends a line per delivery: sequence, sample, recovered."""

import sys
from pathlib import Path

from schemas.imu import ImuBatch
from services.bus.connection import Bus
from services.bus.loop import EventLoop
from services.bus.receiver import Delivery
from services.bus.settings import BusSettings
from services.flow.message import decode_payload
from tests.system.stage import HUB


def main() -> None:
    session, path = sys.argv[1:]
    loop = EventLoop(Bus.open(BusSettings(), "consumer"))
    with Path(path).open("a", buffering=1) as file:

        def deliver(delivery: Delivery) -> None:
            payload = decode_payload(HUB.signal, delivery.envelope, delivery.payload)
            value = payload.sensors[0].captured_ns[0] if isinstance(payload, ImuBatch) else -1
            file.write(f"{delivery.envelope.sequence} {value} {int(delivery.recovered)}\n")

        loop.receive(session, HUB, None, deliver)
        loop.run()


if __name__ == "__main__":
    main()
