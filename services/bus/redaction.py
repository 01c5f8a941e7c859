"""What must never stand in a log: who a person is, what opens a door. Blanked by a field's name and by its look."""

import re

BLANK = "[redacted]"

SECRET_WORDS = frozenset(
    {"name", "names", "surname", "forename", "birthday"}
    | {"password", "passwords", "passphrase", "secret", "secrets", "credential", "credentials"}
    | {"token", "tokens", "cookie", "cookies", "authorization", "key", "keys"}
)
"""A field with one of these among the words of its name is blanked, whatever it holds."""
SECRET_FIELDS = frozenset({"record_number", "date_of_birth", "free_text"})

_LOOKS = (
    (re.compile(r"\bambula_[0-9A-Za-z]+_[\w-]{8,}"), BLANK),
    (re.compile(r"(?i)\b(bearer|basic)\s+[\w.~+/=-]{8,}"), rf"\1 {BLANK}"),
    (re.compile(r"(?i)\b((?:set-)?cookie|authorization)(['\"]?\s*[:=]\s*)[^\r\n]+"), rf"\1\2{BLANK}"),
    (re.compile(r"\b((?:__Host-)?ambula=)[^;,\s'\"]+"), rf"\1{BLANK}"),
    (re.compile(r"\b[0-9a-f]{16}\.[\w-]{20,}"), BLANK),
    (re.compile(r"\beyJ[\w-]+\.[\w-]+\.[\w-]*"), BLANK),
    (re.compile(r"\$argon2\w*\$[\w$=,+/.-]+"), BLANK),
    (re.compile(r"(?<=://)([^\s/:@]*):[^\s@]+(?=@)"), rf"\1:{BLANK}"),
    (
        re.compile(
            r"(?i)\b((?:\w+_)?(?:name|surname|password|passphrase|secret|token|record_number))"
            r"(['\"]?\s*[:=]\s*)(\"[^\"\r\n]*\"|'[^'\r\n]*'|[^,;&}\])'\"\r\n]+)"
        ),
        rf"\1\2{BLANK}",
    ),
    (re.compile(r"\[parameters: .*?\]\s*(?=\(Background|\n|$)", re.DOTALL), f"[parameters: {BLANK}]"),
    (re.compile(r"input_value=.*?(?=, input_type=)", re.DOTALL), f"input_value={BLANK}"),
)
"""Bearer keys, cookies, sign-ins, tokens, kept passwords, passwords in addresses, names, what a database was given."""


def redacted(fields: dict[str, object]) -> dict[str, object]:
    """Fields of an event as they may be written: nested ones too, secrets blanked, anything else left as it is."""
    return {field: BLANK if is_secret(field) else _free_of_secrets(value) for field, value in fields.items()}


def is_secret(field: str) -> bool:
    """Whether a field's name says that it holds a secret or names a person."""
    name = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", field).lower().replace("-", "_")
    return name in SECRET_FIELDS or bool(SECRET_WORDS & set(name.split("_")))


def redacted_text(text: str) -> str:
    """Free text without what looks like a secret; of an exception, too."""
    for look, put in _LOOKS:
        text = look.sub(put, text)
    return text


def _free_of_secrets(value: object) -> object:
    match value:
        case None | bool() | int() | float():
            return value
        case dict():
            return redacted({str(field): each for field, each in value.items()})
        case list() | tuple() | set() | frozenset():
            return [_free_of_secrets(each) for each in value]
        case _:
            return redacted_text(str(value))
