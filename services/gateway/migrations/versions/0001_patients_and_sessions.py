"""Patients, sessions and their metrics."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None

TIME = sa.DateTime(timezone=True)


def upgrade() -> None:
    """Create the three tables."""
    op.create_table(
        "patient",
        sa.Column("code", sa.String(16), primary_key=True),
        sa.Column("year_of_birth", sa.Integer, nullable=True),
        sa.Column("created", TIME, nullable=False),
    )
    op.create_table(
        "session",
        sa.Column("id", sa.String(64), primary_key=True),
        sa.Column("patient_code", sa.String(16), sa.ForeignKey("patient.code"), nullable=True),
        sa.Column("title", sa.String(200), nullable=False),
        sa.Column("protocol", sa.String(100), nullable=False),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("reason", sa.String(500), nullable=True),
        sa.Column("created", TIME, nullable=False),
        sa.Column("started", TIME, nullable=True),
        sa.Column("ended", TIME, nullable=True),
        sa.Column("duration_s", sa.Double, nullable=True),
        sa.Column("estimator", sa.String(64), nullable=False),
        sa.Column("origin", sa.String(16), nullable=False),
        sa.Column("source", sa.String(300), nullable=True),
    )
    for column in ("patient_code", "state", "created"):
        op.create_index(f"ix_session_{column}", "session", [column])
    op.create_table(
        "session_metrics",
        sa.Column("session_id", sa.String(64), sa.ForeignKey("session.id", ondelete="CASCADE"), primary_key=True),
        sa.Column("final", sa.Boolean, nullable=False),
        sa.Column("received", TIME, nullable=False),
        sa.Column("body", sa.JSON, nullable=False),
    )


def downgrade() -> None:
    """Back to an empty database."""
    op.drop_table("session_metrics")
    op.drop_table("session")
    op.drop_table("patient")
