"""What each session's person is asked to do, and how its sensors were found to sit."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Add the columns and the table. Whatever ran before was a walk."""
    op.add_column("session", sa.Column("task", sa.String(32), nullable=True))
    op.add_column("session", sa.Column("walkway_m", sa.Double, nullable=True))
    op.execute("UPDATE session SET task = 'walk' WHERE started IS NOT NULL")
    op.create_table(
        "session_calibration",
        sa.Column("session_id", sa.String(64), sa.ForeignKey("session.id", ondelete="CASCADE"), primary_key=True),
        sa.Column("received", sa.DateTime(timezone=True), nullable=False),
        sa.Column("body", sa.JSON, nullable=False),
    )


def downgrade() -> None:
    """Without them."""
    op.drop_table("session_calibration")
    op.drop_column("session", "walkway_m")
    op.drop_column("session", "task")
