"""Our own check of what is attached: that it is what it says, whole, and where it says."""

import base64
import binascii
import hashlib
import re
from collections.abc import Iterator

from services.exports.fhir.codes import Json

MEDIA_TYPES = ("application/pdf", "application/vnd.mcap")
_LINK = re.compile(r"https?://[^\s/]+/\S*")


def attachment_problems(attachment: Json) -> Iterator[str]:
    """What is wrong with a FHIR Attachment."""
    if attachment.get("contentType") not in MEDIA_TYPES:
        yield f"contentType {attachment.get('contentType')!r} is none of ours"
    if ("data" in attachment) == ("url" in attachment):
        yield "has not exactly one of data and url"
    if "url" in attachment and not _LINK.fullmatch(str(attachment["url"])):
        yield f"{attachment['url']!r} is no address that can be opened elsewhere"
    if "data" in attachment:
        yield from _data(attachment)


def _data(attachment: Json) -> Iterator[str]:
    try:
        data = base64.b64decode(attachment["data"], validate=True)
    except (binascii.Error, ValueError, TypeError):
        yield "data is no base64"
        return
    if attachment.get("contentType") == "application/pdf" and not data.startswith(b"%PDF-"):
        yield "is no PDF"
    if attachment.get("size") != len(data):
        yield f"size is {attachment.get('size')}, not {len(data)} bytes"
    digest = base64.b64encode(hashlib.sha1(data, usedforsecurity=False).digest()).decode("ascii")
    if attachment.get("hash") != digest:
        yield "hash is not that of the data"
