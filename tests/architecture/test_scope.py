"""Who may leave the scope of a caller: named modules, each with its reason. All others see what their caller may see.

Whoever adds a row here says why no caller's scope would do.
"""

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path

from services.gateway.access.scope import NARROWED

ROOT = Path(__file__).parents[2]
CODE = sorted(path for path in (ROOT / "services").rglob("*.py") if "node_modules" not in path.parts)

EVERYTHING = {
    "services/gateway/access/identify.py": "who asks is not known yet",
    "services/gateway/accounts/administration.py": "accounts, which a site's administrator has in every clinic",
    "services/gateway/accounts/attempts.py": "who signs in is not known yet",
    "services/gateway/accounts/housekeeping.py": "sign-ins that have expired, of everybody",
    "services/gateway/accounts/oidc/routes.py": "who signs in is not known yet",
    "services/gateway/accounts/own.py": "the caller's own account and sign-ins",
    "services/gateway/accounts/routes.py": "who signs in is not known yet",
    "services/gateway/app.py": "whether there is any account",
    "services/gateway/audit/routes.py": "the chain of all clinics is verified as one; entries are chosen by clinic",
    "services/gateway/audit/trail.py": "entries of the audit, also about nobody known",
    "services/gateway/clinics/routes.py": "clinics, which a site's administrator has all of",
    "services/gateway/devices/routes.py": "whether another clinic has registered the same source",
    "services/gateway/directory/store.py": "names, in a database where nothing else is",
    "services/gateway/erasure/eraser.py": "what is erased, whoever it belonged to",
    "services/gateway/erasure/housekeeping.py": "the bin and the retention of every clinic",
    "services/gateway/keys/routes.py": "who made a key may work in another clinic by now",
    "services/gateway/live/routes.py": "entries of the audit",
    "services/gateway/monitoring/site.py": "numbers about the site, none about a patient",
    "services/gateway/patients/record_routes.py": "two records of one person, with what of them is in the bin",
    "services/gateway/recycling/routes.py": "a session in the bin whose patient is not: no scope has both",
    "services/gateway/sessions/keeper.py": "what the services say about sessions, whoever they belong to",
    "services/gateway/sources/offered.py": "which sources other clinics have registered",
    "services/cli/doctor/stored.py": "a command of whoever has the database itself",
    "services/cli/audit.py": "a command of whoever has the database itself",
    "services/cli/picture_visits.py": "pictures of a made-up patient",
    "services/cli/reprocess/storing.py": "a command of whoever has the database itself",
}
"""May have a transaction in which everything exists."""

OF_PATIENTS_TOO = {
    "services/gateway/monitoring/site.py": "counts sessions by state",
    "services/gateway/erasure/housekeeping.py": "the bin and the retention of every clinic",
    "services/gateway/patients/record_routes.py": "two records of one person, with what of them is in the bin",
    "services/gateway/recycling/routes.py": "a session in the bin whose patient is not: no scope has both",
    "services/cli/picture_visits.py": "pictures of a made-up patient",
}
"""Those among them that name tables of patients and sessions themselves."""

SCOPES = {
    "services/gateway/access/scope.py": "defines it",
    "services/gateway/access/caller.py": "the one of a caller",
}
"""May make a scope."""

ENGINES = {
    "services/gateway/database.py": "the one door",
    "services/gateway/revisions.py": "the schema's revision, for `ambula doctor`",
    "services/cli/backup/databases.py": "copies whole databases, for whoever has them",
}
"""May connect to a database."""

PLAIN_SQL = {
    "services/gateway/access/statements.py": "refuses it",
    "services/gateway/database.py": "whether it answers, and what SQLite needs",
    "services/cli/backup/databases.py": "copies whole databases, for whoever has them",
}
"""May send SQL that is written as text."""

LEADS_AROUND = {"__table__", "from_statement", "exec_driver_sql", "get_bind", "bind_mapper", "connection", "engine"}
"""Attributes of a transaction, a class or a database through which a query would not be narrowed."""

AROUND = {
    *ENGINES,
    "services/gateway/access/statements.py",
    "services/gateway/migrations/env.py",
}


def parsed() -> Iterator[tuple[str, ast.Module]]:
    for path in CODE:
        yield path.relative_to(ROOT).as_posix(), ast.parse(path.read_text())


TREES = dict(parsed())


def imported(tree: ast.Module, *modules: str) -> set[str]:
    """Names that come from the modules, also inside functions."""
    found = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module in modules]
    return {each.name for node in found for each in node.names}


def imports(name: str, *modules: str) -> set[str]:
    return {path for path, tree in TREES.items() if name in imported(tree, *modules)}


def modules_with(name: str) -> set[str]:
    """Modules that import a whole module by that name, through which its parts could be reached unseen."""
    found = set()
    for path, tree in TREES.items():
        parts = [node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom)]
        whole = {
            f"{node.module}.{each.name}" for node in parts if isinstance(node, ast.ImportFrom) for each in node.names
        }
        whole |= {each.name for node in parts if isinstance(node, ast.Import) for each in node.names}
        if name in whole:
            found.add(path)
    return found


def check(found: set[str], listed: Mapping[str, str]) -> None:
    """Exactly the listed modules, as far as they are there."""
    assert found - listed.keys() == set(), "not in the list"
    assert listed.keys() & TREES.keys() - found == set(), "listed without need"


def test_everything_is_for_named_modules():
    check(imports("EVERYTHING", "services.gateway.access.scope"), EVERYTHING)
    assert modules_with("services.gateway.access.scope") == set()


def test_tables_of_patients_and_everything_do_not_meet_but_in_named_modules():
    tables = {each.__name__ for each in NARROWED}
    naming = {path for path, tree in TREES.items() if tables & imported(tree, "services.gateway.tables")}
    check(naming & EVERYTHING.keys(), OF_PATIENTS_TOO)


def test_scopes_are_made_from_callers():
    made = {
        path
        for path, tree in TREES.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Scope"
        if "Scope" in imported(tree, "services.gateway.access.scope") or path == "services/gateway/access/scope.py"
    }
    replaced = {path for path, tree in TREES.items() if "replace" in imported(tree, "dataclasses") and _has_scope(tree)}
    check(made, SCOPES)
    assert replaced == set()


def _has_scope(tree: ast.Module) -> bool:
    return "Scope" in imported(tree, "services.gateway.access.scope")


def test_databases_are_opened_in_named_modules():
    names = ("sessionmaker", "create_engine", "Engine", "scoped_session", "create_async_engine")
    homes = ("sqlalchemy", "sqlalchemy.orm", "sqlalchemy.ext.asyncio")
    check(set().union(*(imports(name, *homes) for name in names)), ENGINES)
    assert modules_with("sqlalchemy") - {path for path in TREES if "/migrations/" in path} == set()
    assert modules_with("sqlite3") - ENGINES.keys() == set()


def test_sql_is_not_written_as_text():
    found = {
        path
        for name in ("text", "literal_column", "TextClause")
        for path in imports(name, "sqlalchemy", "sqlalchemy.sql", "sqlalchemy.sql.expression")
        if "/migrations/" not in path
    }
    check(found, PLAIN_SQL)


def test_no_query_leads_around_the_scope():
    free = {path for path in TREES if path in AROUND or "/migrations/versions/" in path}
    for path in TREES.keys() - free:
        if path.startswith("services/gateway/"):
            used = {node.attr for node in ast.walk(TREES[path]) if isinstance(node, ast.Attribute)}
            assert used & LEADS_AROUND == set(), path


def test_a_session_of_the_database_is_made_in_one_place():
    made = {
        path
        for path, tree in TREES.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Session"
        if "Session" in imported(tree, "sqlalchemy.orm")
    }
    assert made == set()
