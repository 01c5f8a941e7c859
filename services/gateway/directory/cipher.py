"""How a name is kept: encrypted with AES-256-GCM, under a keyed digest of the patient code."""

import hashlib
import hmac
import os
import secrets
from pathlib import Path

from cryptography.exceptions import InvalidTag
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.ciphers.aead import AESGCM
from cryptography.hazmat.primitives.kdf.hkdf import HKDF
from pydantic import BaseModel, ConfigDict

KEY_BYTES = 32
NONCE_BYTES = 12


class DirectoryUnusable(RuntimeError):
    """The key is not there, or does not fit what is stored; says what to do."""


class Name(BaseModel):
    """Who a patient is."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str
    record_number: str | None


class Cipher:
    """Seals and opens entries with keys drawn from one secret."""

    def __init__(self, secret: bytes) -> None:
        self._sealing = AESGCM(_derived(secret, b"ambula directory: entries"))
        self._placing = _derived(secret, b"ambula directory: places")

    def place_of(self, code: str) -> str:
        """Under what a patient's entry stands, hexadecimal: without the key no entry is brought to its patient."""
        return hmac.new(self._placing, code.encode(), hashlib.sha256).hexdigest()

    def seal(self, code: str, name: Name) -> bytes:
        """Nonce and ciphertext; an entry that is moved to another patient does not open there."""
        nonce = secrets.token_bytes(NONCE_BYTES)
        text = name.model_dump_json().encode()
        return nonce + self._sealing.encrypt(nonce, text, self.place_of(code).encode())

    def open(self, code: str, sealed: bytes) -> Name:
        """Inverse of `seal`. Raises DirectoryUnusable for another key, patient or content."""
        nonce, text = sealed[:NONCE_BYTES], sealed[NONCE_BYTES:]
        try:
            return Name.model_validate_json(self._sealing.decrypt(nonce, text, self.place_of(code).encode()))
        except (InvalidTag, ValueError) as error:
            raise DirectoryUnusable(
                "An entry of the directory does not open: its key file is another one, or the entry was changed."
            ) from error


def read_key(file: Path) -> bytes | None:
    """The secret; None when there is none yet. Raises DirectoryUnusable for a file that holds something else."""
    if not file.exists():
        return None
    try:
        secret = bytes.fromhex(file.read_text(encoding="ascii").strip())
    except ValueError:
        secret = b""
    if len(secret) != KEY_BYTES:
        raise DirectoryUnusable("The key file of the directory holds no key; restore it from a backup.")
    return secret


def make_key(file: Path) -> bytes:
    """Draw a secret and keep it where only the gateway's user can read it. Raises OSError."""
    file.parent.mkdir(parents=True, exist_ok=True)
    secret = secrets.token_bytes(KEY_BYTES)
    with os.fdopen(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="ascii") as opened:
        opened.write(secret.hex() + "\n")
        opened.flush()
        os.fsync(opened.fileno())
    return secret


def _derived(secret: bytes, purpose: bytes) -> bytes:
    return HKDF(hashes.SHA256(), KEY_BYTES, salt=None, info=purpose).derive(secret)
