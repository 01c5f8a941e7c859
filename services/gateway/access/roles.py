"""Roles, and what each of them may do. Nobody may do what is not in this table."""

from enum import StrEnum


class Role(StrEnum):
    """What an account or a key is for."""

    VIEWER = "viewer"
    THERAPIST = "therapist"
    ADMIN = "admin"
    SERVICE = "service"


class Permission(StrEnum):
    """What a route asks for. Each route asks for exactly one."""

    KNOWN = "known"
    """Anybody who has signed in: their own account, words, reference sets."""
    READ = "read"
    """Patients and sessions of the own clinic, and those that were shared."""
    WORK = "work"
    """Register patients, start and stop sessions, link, correct, share, put into the bin."""
    NAMES = "names"
    """The directory of names: never a machine, never somebody who only looks on."""
    ADMINISTER = "administer"
    """Accounts, devices, keys, audit, retention and erasure of the own clinic."""
    OPERATE = "operate"
    """Numbers about the services themselves, for monitoring."""


MAY: dict[Permission, frozenset[Role]] = {
    Permission.KNOWN: frozenset(Role),
    Permission.READ: frozenset(Role),
    Permission.WORK: frozenset({Role.THERAPIST, Role.ADMIN, Role.SERVICE}),
    Permission.NAMES: frozenset({Role.THERAPIST, Role.ADMIN}),
    Permission.ADMINISTER: frozenset({Role.ADMIN}),
    Permission.OPERATE: frozenset({Role.ADMIN, Role.SERVICE}),
}

ABOUT_PATIENTS = frozenset({Permission.READ, Permission.WORK, Permission.NAMES})
"""Every request that needs one of these is in the audit, reading included."""
