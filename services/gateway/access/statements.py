"""Statements that a scope can not be added to are refused, so that no wording of a query leads around it."""

from collections.abc import Collection, Iterable
from typing import Any, cast

from sqlalchemy import Alias, ClauseElement, Column, FromClause, Select, TextClause
from sqlalchemy.orm import DeclarativeBase, ORMExecuteState
from sqlalchemy.sql import visitors

MAPPED = "parententity"
"""What SQLAlchemy notes on a table or column that was named by its mapped class."""


class OutOfScope(PermissionError):
    """Something was to be read or written that is not the caller's."""


def check_statement(state: ORMExecuteState, narrowed: Collection[type[DeclarativeBase]]) -> None:
    """Raises OutOfScope for plain SQL, for narrowed tables that are not named by their class, and for writing to those
    many at once: conditions are added to mapped classes alone, and `check_rows` sees rows alone.
    """
    if not state.is_orm_statement:
        raise OutOfScope("a query as a caller names mapped classes")
    if (state.is_insert or state.is_update or state.is_delete) and _written(state) in narrowed:
        raise OutOfScope("what is known of patients is written row by row")
    tables, statement = {each.__table__ for each in narrowed}, cast(ClauseElement, state.statement)
    for part in visitors.iterate(statement):
        if isinstance(part, TextClause) or _is_bare(part, tables):
            raise OutOfScope("a query as a caller names mapped classes, also inside")


def _written(state: ORMExecuteState) -> type | None:
    return None if state.bind_mapper is None else state.bind_mapper.class_


def _is_bare(part: Any, tables: Collection[FromClause]) -> bool:
    """Whether a SELECT has a narrowed table, or a column of one, that is not named by its class."""
    if not isinstance(part, Select):
        return False
    if part._propagate_attrs.get("compile_state_plugin") != "orm":
        return any(_named(each) in tables for each in part.get_final_froms())
    shown = [_named(each) for each in part._raw_columns if MAPPED in each._annotations]
    bare = [*_bare_columns(part._raw_columns), *_bare_columns(part._where_criteria)]
    # `Session.get` itself compares the bare key of the class that it selects.
    allowed = {each._deannotate() for each in shown} if not _bare_columns(part._raw_columns) else set()
    return any(_named(each.table) in tables and _named(each.table) not in allowed for each in bare)


def _bare_columns(parts: Iterable[Any]) -> list[Column[Any]]:
    found = (each for part in parts for each in visitors.iterate(part))
    return [each for each in found if isinstance(each, Column) and MAPPED not in each._annotations]


def _named(source: Any) -> Any:
    """The table behind aliases."""
    return _named(source.element) if isinstance(source, Alias) else source
