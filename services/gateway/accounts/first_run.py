"""The first administrator: whoever can read the gateway's folder or its terminal, and nobody else on the network."""

import hmac
import os
import secrets
from pathlib import Path

FILE = "first-run-code"
ALPHABET = "23456789ABCDEFGHJKMNPQRSTVWXYZ"
LENGTH = 10


def code_file(data_dir: Path) -> Path:
    """Where the code lies until it is used."""
    return data_dir / FILE


def write_code(data_dir: Path) -> str:
    """Draw a code and keep it where only the gateway's user can read it; the one that is there stays."""
    path = code_file(data_dir)
    if path.exists():
        return path.read_text(encoding="utf-8").strip()
    data_dir.mkdir(parents=True, exist_ok=True)
    code = "".join(secrets.choice(ALPHABET) for _ in range(LENGTH))
    with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as file:
        file.write(code + "\n")
    return code


def is_code(data_dir: Path, code: str) -> bool:
    """Whether it is the code that was written."""
    path = code_file(data_dir)
    return path.exists() and hmac.compare_digest(path.read_text(encoding="utf-8").strip(), code.strip().upper())


def forget_code(data_dir: Path) -> None:
    """It has been used."""
    code_file(data_dir).unlink(missing_ok=True)
