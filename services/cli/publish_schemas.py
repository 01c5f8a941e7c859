"""Writes the JSON Schema of every signal's model into schemas/published."""

import json
from pathlib import Path

import schemas
from schemas.signals import SIGNALS

PUBLISHED = Path(schemas.__file__).parent / "published"


def schema_texts() -> dict[str, str]:
    """File name -> JSON Schema text of each signal's model."""
    return {
        f"{signal.name}.schema.json": json.dumps(signal.model.model_json_schema(), indent=2, sort_keys=True) + "\n"
        for signal in SIGNALS
    }


def publish() -> None:
    """Write all; remove what no signal needs any more."""
    PUBLISHED.mkdir(exist_ok=True)
    texts = schema_texts()
    for path in PUBLISHED.glob("*.schema.json"):
        if path.name not in texts:
            path.unlink()
    for name, text in texts.items():
        (PUBLISHED / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    publish()
