"""The certificate of the page: whether it can be used, for whom it is, and until when."""

import ssl
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from cryptography import x509
from cryptography.x509.oid import NameOID

HOW = "set AMBULA_HTTP_CERTIFICATE and AMBULA_HTTP_KEY to a certificate and its key in PEM format"


class CertificateError(ValueError):
    """Certificate and key cannot be used; says what to do."""


@dataclass(frozen=True, slots=True)
class Certificate:
    """What a certificate says. Times in UTC."""

    names: tuple[str, ...]
    begins: datetime
    ends: datetime

    def days_left(self, now: datetime) -> float:
        """Until browsers refuse it; negative when they do already."""
        return (self.ends - now).total_seconds() / 86400


def read_pair(certificate: Path, key: Path) -> Certificate:
    """What the certificate says, once it is sure that it and its key belong together. Raises CertificateError."""
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(certificate, key, password=_no_password)
        loaded = x509.load_pem_x509_certificates(certificate.read_bytes())[0]
    except FileNotFoundError as error:
        missing = next((path for path in (certificate, key) if not path.exists()), certificate)
        raise CertificateError(f"{missing} is not there; {HOW}") from error
    except (OSError, ValueError) as error:
        raise CertificateError(f"{certificate} and {key} cannot be used together ({error}); {HOW}") from error
    return Certificate(_names(loaded), loaded.not_valid_before_utc.astimezone(UTC), loaded.not_valid_after_utc)


def trusting(certificate: Path) -> ssl.SSLContext:
    """For programs on this machine that talk to the own gateway: they believe its certificate and no other.

    The name is not compared: they use the loopback address, and the certificate bears the name for browsers.
    """
    context = ssl.create_default_context(cafile=str(certificate))
    context.check_hostname = False
    return context


def _no_password() -> str:
    raise ValueError("the key is encrypted; services start without anybody there to type its password")


def _names(certificate: x509.Certificate) -> tuple[str, ...]:
    try:
        names = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
        return tuple(str(each.value) for each in names)
    except x509.ExtensionNotFound:
        return tuple(str(each.value) for each in certificate.subject.get_attributes_for_oid(NameOID.COMMON_NAME))
