"""`ambula send-skeletons`: a recorded or simulated person as a capture PC would send it."""

import socket
import time
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from services.cli.console import err, out, told


def send_skeletons(
    path: Annotated[
        str,
        typer.Argument(metavar="PATH", help="what `ambula replay` takes, with a camera in it, e.g. kimore_squat"),
    ],
    port: Annotated[int, typer.Option(min=1, max=65535, help="UDP port that an ingest listens on")] = 7788,
    host: Annotated[str, typer.Option(help="computer of that ingest")] = "127.0.0.1",
) -> None:
    """Send the skeletons of a recording to a port, in real time: a capture PC to try things with."""
    from services.ingest.errors import SourceError

    with told(SourceError, OSError):
        frames, seconds = send(path, host, port, err)
    out.print(f"sent: {frames} frames in {seconds:.1f} s to {host} port {port}")


def send(spec: str, host: str, port: int, console: Console) -> tuple[int, float]:
    """Send a source's skeleton frames to a UDP port, each when it is due; their number, and the s they span.

    Raises SourceError for a source that cannot be read or has no camera, OSError for an address that there is not.
    """
    from services.ingest.capture.sender import camera_to_send, datagrams
    from services.ingest.source import open_source

    source = open_source(spec)
    description = source.describe()
    camera = camera_to_send(description)
    family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[at]}"))
    sent, at_s = 0, 0.0
    console.print(f'sending to {host} port {port}; to see it live: ambula replay "device:kinect?port={port}"')
    with socket.socket(family, kind, protocol) as sending, Progress(*columns, console=console) as progress:
        bar = progress.add_task(f"sending {description.title}", total=description.duration_s, at="")
        began_s: float | None = None
        for captured_ns, datagram in datagrams(camera, source.messages()):
            at_s = captured_ns * 1e-9
            began_s = time.monotonic() - at_s if began_s is None else began_s
            time.sleep(max(0.0, began_s + at_s - time.monotonic()))
            sending.sendto(datagram, address)
            sent += 1
            progress.update(bar, completed=at_s, at=f"{sent} frames, {at_s:.1f} s")
    return sent, at_s
