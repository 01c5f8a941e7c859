"""Where the chain ended, signed every day with a key outside of the database: so a cut end can be told.

Who can write the database cannot sign; who keeps a copy of these lines elsewhere can tell a chain written anew.
"""

import json
import os
from datetime import UTC, datetime, timedelta
from pathlib import Path

from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from services.gateway.audit.chain import BEGINNING

KEY_FILE = "audit.key"
HEADS_FILE = "audit-heads.ndjson"
EVERY = timedelta(days=1)


class HeadsUnusable(RuntimeError):
    """The signed heads, or the key they were signed with, are not as they were; says what to do."""


class SignedHead(BaseModel):
    """The chain's end at a time: number and digest of its last entry. The signature is Ed25519 over `signed_text`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    at: datetime
    number: int = Field(ge=0)
    digest: str
    signature: str = Field(description="hexadecimal")

    @property
    def signed_text(self) -> bytes:
        """What the signature covers."""
        return _text(self.at, self.number, self.digest)


class Heads:
    """The file of signed heads and its key, in the gateway's own folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._key_file = folder / KEY_FILE
        self._file = folder / HEADS_FILE

    def read(self) -> list[SignedHead]:
        """All heads, oldest first. Raises HeadsUnusable where one was changed or the key is gone."""
        lines = self._file.read_text(encoding="utf-8").splitlines() if self._file.exists() else []
        if not lines:
            return []
        key = self._known_key()
        return [self._checked(number, line, key) for number, line in enumerate(lines, 1)]

    def sign_if_due(self, number: int, digest: str, now: datetime) -> SignedHead | None:
        """Sign the chain's end when the last signature is a day old. Raises HeadsUnusable, OSError."""
        heads = self.read()
        if digest == BEGINNING or (heads and now - heads[-1].at < EVERY):
            return None
        text = _text(now, number, digest)
        head = SignedHead(at=now, number=number, digest=digest, signature=self._signing_key().sign(text).hex())
        with self._file.open("a", encoding="utf-8") as file:
            file.write(head.model_dump_json() + "\n")
            file.flush()
            os.fsync(file.fileno())
        return head

    def _checked(self, line_number: int, line: str, key: Ed25519PublicKey) -> SignedHead:
        try:
            head = SignedHead.model_validate_json(line)
            key.verify(bytes.fromhex(head.signature), head.signed_text)
        except (ValidationError, ValueError, InvalidSignature) as error:
            raise HeadsUnusable(
                f"line {line_number} of {HEADS_FILE} is not as it was signed; compare it with a backup"
            ) from error
        return head

    def _known_key(self) -> Ed25519PublicKey:
        if not self._key_file.exists():
            raise HeadsUnusable(f"{KEY_FILE} is gone, so the signed heads cannot be checked; restore it from a backup")
        return self._loaded().public_key()

    def _signing_key(self) -> Ed25519PrivateKey:
        if not self._key_file.exists():
            self._folder.mkdir(parents=True, exist_ok=True)
            text = Ed25519PrivateKey.generate().private_bytes(
                serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
            )
            with os.fdopen(os.open(self._key_file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
                file.write(text)
        return self._loaded()

    def _loaded(self) -> Ed25519PrivateKey:
        key = serialization.load_pem_private_key(self._key_file.read_bytes(), password=None)
        assert isinstance(key, Ed25519PrivateKey)
        return key


def _text(at: datetime, number: int, digest: str) -> bytes:
    return json.dumps([at.astimezone(UTC).isoformat(timespec="microseconds"), number, digest]).encode()
