"""Run by Alembic for each migration; the connection comes from `services.gateway.database`."""

from alembic import context

import services.gateway.access.tables
import services.gateway.audit.tables  # noqa: F401 - they add their tables to Base
from services.gateway.tables import Base

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=Base.metadata,
    render_as_batch=True,
)
with context.begin_transaction():
    context.run_migrations()
