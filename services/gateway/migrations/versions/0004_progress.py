"""What progress needs: who the person is compared with, how each test was done, and what it is counted from."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

PATIENT = {"sex": 16, "population": 32, "paretic_side": 8}


def upgrade() -> None:
    """Add columns and tables. Metrics that are there came from the only version there was."""
    for name, length in PATIENT.items():
        op.add_column("patient", sa.Column(name, sa.String(length), nullable=True))
    op.add_column("session", sa.Column("description", sa.JSON, nullable=True))
    first = sa.Column("software", sa.String(100), nullable=False, server_default="ambula 0.1.0")
    op.add_column("session_metrics", first)
    op.create_table(
        "session_former_metrics",
        sa.Column("session_id", sa.String(64), sa.ForeignKey("session.id", ondelete="CASCADE"), primary_key=True),
        sa.Column("software", sa.String(100), primary_key=True),
        sa.Column("received", sa.DateTime(timezone=True), nullable=False),
        sa.Column("replaced", sa.DateTime(timezone=True), nullable=False),
        sa.Column("body", sa.JSON, nullable=False),
    )
    op.create_table(
        "patient_baseline",
        sa.Column("patient_code", sa.String(16), sa.ForeignKey("patient.code", ondelete="CASCADE"), primary_key=True),
        sa.Column("session_id", sa.String(64), sa.ForeignKey("session.id", ondelete="CASCADE"), nullable=False),
        sa.Column("frozen", sa.DateTime(timezone=True), nullable=False),
        sa.Column("body", sa.JSON, nullable=False),
    )
    op.create_table(
        "patient_treatment",
        sa.Column("id", sa.Integer, primary_key=True, autoincrement=True),
        sa.Column("patient_code", sa.String(16), sa.ForeignKey("patient.code", ondelete="CASCADE"), nullable=False),
        sa.Column("on_date", sa.Date, nullable=False),
        sa.Column("what", sa.String(32), nullable=False),
    )
    op.create_index("ix_patient_treatment_patient_code", "patient_treatment", ["patient_code"])


def downgrade() -> None:
    """Without them."""
    for table in ("patient_treatment", "patient_baseline", "session_former_metrics"):
        op.drop_table(table)
    op.drop_column("session_metrics", "software")
    op.drop_column("session", "description")
    for name in reversed(PATIENT):
        op.drop_column("patient", name)
