"""Every operation of the API as a request that would succeed, made from the published description alone."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from services.gateway.openapi_file import FILE

DOCUMENT = json.loads(FILE.read_text())
METHODS = ("get", "post", "put", "patch", "delete")


class NoSample(AssertionError):
    """The description does not say what a good request looks like."""


@dataclass(frozen=True)
class Operation:
    """One method of one path."""

    method: str
    path: str
    described: Mapping[str, Any]

    @property
    def name(self) -> str:
        """As it stands in tables of tests."""
        return f"{self.method} {self.path}"

    @property
    def permission(self) -> str | None:
        """What it asks for; None when it is open to all."""
        permission: str | None = self.described["x-permission"]
        return permission

    @property
    def path_names(self) -> set[str]:
        """Names of the values in its path."""
        return {each["name"] for each in self.described.get("parameters", ()) if each["in"] == "path"}

    @property
    def query(self) -> Mapping[str, Mapping[str, Any]]:
        """Its query parameters."""
        return {each["name"]: each for each in self.described.get("parameters", ()) if each["in"] == "query"}

    @property
    def body_schema(self) -> Mapping[str, Any] | None:
        """Of a JSON body; None when there is none."""
        if "requestBody" not in self.described:
            return None
        schema: Mapping[str, Any] = self.described["requestBody"]["content"]["application/json"]["schema"]
        return resolved(schema)

    def address(self, values: Mapping[str, object]) -> str:
        """The path with its values, and required query parameters. Raises NoSample for a value nobody has named."""
        missing = self.path_names - values.keys()
        if missing:
            raise NoSample(f"{self.name}: say in site.py what {' and '.join(sorted(missing))} are")
        needed = [name for name, each in self.query.items() if each.get("required")]
        query = "&".join(f"{name}={values[name] if name in values else self._example_of(name)}" for name in needed)
        return self.path.format_map(dict(values)) + (f"?{query}" if query else "")

    def body(self, values: Mapping[str, object]) -> Any:
        """A body of the required fields, and of `values`; None when it takes none."""
        schema = self.body_schema
        if schema is None:
            return None
        required, fields = schema.get("required", ()), schema.get("properties", {})
        return {name: example(fields[name], f"{self.name}: {name}") for name in required} | dict(values)

    def _example_of(self, name: str) -> object:
        parameter = self.query[name]
        if "example" in parameter:
            return parameter["example"]
        return example(parameter["schema"], f"{self.name}: {name}")


def resolved(schema: Mapping[str, Any]) -> Mapping[str, Any]:
    """A schema by its name, or itself."""
    if "$ref" not in schema:
        return schema
    found: Mapping[str, Any] = DOCUMENT["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    return found


def example(schema: Mapping[str, Any], where: str) -> Any:
    """A value that the schema takes, as it says itself. Raises NoSample."""
    schema = resolved(schema)
    for key in ("examples", "enum"):
        if schema.get(key):
            return schema[key][0]
    for key in ("const", "default"):
        if key in schema:
            return schema[key]
    if "anyOf" in schema:
        return example(next(each for each in schema["anyOf"] if each.get("type") != "null"), where)
    if schema.get("type") == "object":
        fields = schema.get("properties", {})
        return {name: example(fields[name], f"{where}.{name}") for name in schema.get("required", ())}
    if schema.get("type") == "array":
        return [example(schema["items"], where)]
    if schema.get("type") == "boolean":
        return True
    raise NoSample(f"{where} has no example: add examples=[...] to the field")


def operations() -> Iterator[Operation]:
    """All of them."""
    for path, methods in DOCUMENT["paths"].items():
        for method in METHODS:
            if method in methods:
                yield Operation(method.upper(), path, methods[method])
