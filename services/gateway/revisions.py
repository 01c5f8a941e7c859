"""Which step of the schema a database is at, and which the code knows; nothing is changed by asking."""

from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import create_engine, make_url
from sqlalchemy.exc import SQLAlchemyError

from services.gateway.database import MIGRATIONS, DatabaseError


def present(url: str) -> str | None:
    """The revision of the database at the URL; None when it has none yet. Raises DatabaseError when it cannot be asked.

    A SQLite file that is not there is not made.
    """
    address = make_url(url)
    if address.get_backend_name() == "sqlite":
        # By its URI a file is opened for reading alone; the path alone would make one that is missing.
        address = address.set(database=f"file:{address.database}", query={"mode": "ro", "uri": "true"})
    engine = create_engine(address, hide_parameters=True)
    try:
        with engine.connect() as connection:
            return MigrationContext.configure(connection).get_current_revision()
    except SQLAlchemyError as error:
        shown = make_url(url).render_as_string(hide_password=True)
        raise DatabaseError(f"cannot read the database {shown}; check AMBULA_DATABASE") from error
    finally:
        engine.dispose()


def newest() -> str:
    """The revision that the code brings a database to."""
    head = _scripts().get_current_head()
    assert head is not None
    return head


def known() -> set[str]:
    """Every revision that the code can start from."""
    return {script.revision for script in _scripts().walk_revisions()}


def _scripts() -> ScriptDirectory:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    return ScriptDirectory.from_config(config)
