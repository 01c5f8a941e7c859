"""What a route asks of whoever calls it. A route without a rule does not start (`rule_of`)."""

from collections.abc import Iterator, Sequence
from http import HTTPStatus
from typing import Any

from fastapi import Depends, params
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute, APIWebSocketRoute
from starlette.routing import BaseRoute

from services.gateway.access.identify import COOKIE, Identified
from services.gateway.access.roles import Permission
from services.gateway.problems import Problem, documented


class Rule:
    """A dependency that lets callers with a permission pass."""

    def __init__(self, permission: Permission) -> None:
        self.permission = permission

    def __call__(self, caller: Identified) -> None:
        """Raises a 403 problem."""
        if not caller.may(self.permission):
            raise Problem(
                HTTPStatus.FORBIDDEN,
                f"Your role ({caller.role}) may not do this.",
                "Ask an administrator of your clinic.",
            )


class OpenToAll:
    """A rule that asks for nothing: signing in, and what a browser needs before."""

    permission = None

    def __call__(self) -> None:
        """Nothing to check."""


def needs(permission: Permission) -> params.Depends:
    """For `dependencies=[needs(Permission.READ)]` of a route or a router."""
    dependency: params.Depends = Depends(Rule(permission))
    return dependency


OPEN_TO_ALL: list[params.Depends] = [Depends(OpenToAll())]

KNOWN = [needs(Permission.KNOWN)]
READ = [needs(Permission.READ)]
WORK = [needs(Permission.WORK)]


class NoRule(TypeError):
    """A route does not say who may call it, or says it twice."""


def rule_of(path: str, dependant: Dependant) -> Permission | None:
    """The permission a route asks for; None when it is open to all. Raises NoRule."""
    rules = [call for call in _calls(dependant) if isinstance(call, Rule | OpenToAll)]
    if len(rules) != 1:
        raise NoRule(f"{path} has {len(rules)} rules; give it exactly one: dependencies=[needs(...)] or OPEN_TO_ALL")
    return rules[0].permission


def check_rules(routes: Sequence[BaseRoute]) -> None:
    """Raises NoRule for the first route, live connections included, that does not say who may call it."""
    for route in routes:
        if isinstance(route, APIRoute | APIWebSocketRoute):
            rule_of(route.path, route.dependant)


def described(routes: Sequence[BaseRoute], document: dict[str, Any]) -> None:
    """Write into an OpenAPI document what each operation asks for."""
    document["components"]["securitySchemes"] = {
        "sign_in": {"type": "apiKey", "in": "cookie", "name": COOKIE},
        "key": {"type": "http", "scheme": "bearer"},
    }
    for route in routes:
        if isinstance(route, APIRoute) and route.include_in_schema:
            for method in route.methods or ():
                operation = document["paths"][route.path][method.lower()]
                _describe(operation, rule_of(route.path, route.dependant))


def _describe(operation: dict[str, Any], permission: Permission | None) -> None:
    operation["x-permission"] = permission
    if permission is not None:
        operation["security"] = [{"sign_in": []}, {"key": []}]
        operation["responses"].update(_REFUSALS)


_REFUSALS = {
    str(status): answer for status, answer in documented(HTTPStatus.UNAUTHORIZED, HTTPStatus.FORBIDDEN).items()
}


def _calls(dependant: Dependant) -> Iterator[Any]:
    for each in dependant.dependencies:
        yield each.call
        yield from _calls(each)
