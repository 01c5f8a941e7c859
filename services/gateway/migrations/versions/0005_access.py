"""Clinics, accounts, keys, shared patients, the bin, devices and the audit."""

from datetime import UTC, datetime

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None

TIME = sa.DateTime(timezone=True)
NUMBER = sa.BigInteger().with_variant(sa.Integer, "sqlite")
FIRST_CLINIC = "main"
SCOPED = ("patient", "session")


def upgrade() -> None:
    """Add tables and columns. What is there belongs to the first clinic."""
    clinic = op.create_table(
        "clinic",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column("name", sa.String(100), nullable=False),
        sa.Column("keep_days", sa.Integer, nullable=True),
        sa.Column("created", TIME, nullable=False),
    )
    op.bulk_insert(clinic, [{"id": FIRST_CLINIC, "name": "Clinic", "keep_days": None, "created": datetime.now(UTC)}])
    for table in SCOPED:
        with op.batch_alter_table(table) as batch:
            batch.add_column(sa.Column("clinic_id", sa.String(32), nullable=False, server_default=FIRST_CLINIC))
            batch.add_column(sa.Column("deleted", TIME, nullable=True))
            batch.create_foreign_key(f"fk_{table}_clinic", "clinic", ["clinic_id"], ["id"])
            batch.create_index(f"ix_{table}_clinic_id", ["clinic_id"])
    _create_accounts()
    _create_belongings()
    _create_audit()


def downgrade() -> None:
    """Without them."""
    for table in ("audit_entry", "audit_head", "device", "patient_share", "api_key", "sign_in", "account"):
        op.drop_table(table)
    if op.get_bind().dialect.name == "postgresql":
        op.execute("DROP FUNCTION IF EXISTS audit_is_append_only()")
    for table in reversed(SCOPED):
        with op.batch_alter_table(table) as batch:
            batch.drop_index(f"ix_{table}_clinic_id")
            batch.drop_constraint(f"fk_{table}_clinic", type_="foreignkey")
            batch.drop_column("deleted")
            batch.drop_column("clinic_id")
    op.drop_table("clinic")


def _create_accounts() -> None:
    op.create_table(
        "account",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column("login", sa.String(64), nullable=False, unique=True),
        sa.Column("role", sa.String(16), nullable=False),
        sa.Column("clinic_id", sa.String(32), sa.ForeignKey("clinic.id"), nullable=False, index=True),
        sa.Column("site_admin", sa.Boolean, nullable=False),
        sa.Column("password", sa.String(200), nullable=True),
        sa.Column("issuer", sa.String(200), nullable=True),
        sa.Column("subject", sa.String(200), nullable=True),
        sa.Column("disabled", sa.Boolean, nullable=False),
        sa.Column("created", TIME, nullable=False),
        sa.Column("failures", sa.Integer, nullable=False),
        sa.Column("locked_until", TIME, nullable=True),
    )
    op.create_table(
        "sign_in",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column(
            "account_id", sa.String(32), sa.ForeignKey("account.id", ondelete="CASCADE"), nullable=False, index=True
        ),
        sa.Column("secret", sa.String(64), nullable=False),
        sa.Column("former_secret", sa.String(64), nullable=True),
        *(sa.Column(name, TIME, nullable=False) for name in ("renewed", "created", "seen", "confirmed")),
    )
    op.create_table(
        "api_key",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column("name", sa.String(64), nullable=False),
        sa.Column("secret", sa.String(64), nullable=False),
        sa.Column("role", sa.String(16), nullable=False),
        sa.Column("clinic_id", sa.String(32), sa.ForeignKey("clinic.id"), nullable=False, index=True),
        sa.Column("created_by", sa.String(32), sa.ForeignKey("account.id", ondelete="SET NULL"), nullable=True),
        sa.Column("created", TIME, nullable=False),
        sa.Column("expires", TIME, nullable=False),
        sa.Column("used", TIME, nullable=True),
        sa.Column("revoked", TIME, nullable=True),
    )


def _create_belongings() -> None:
    op.create_table(
        "patient_share",
        sa.Column("patient_code", sa.String(16), sa.ForeignKey("patient.code", ondelete="CASCADE"), primary_key=True),
        sa.Column("account_id", sa.String(32), sa.ForeignKey("account.id", ondelete="CASCADE"), primary_key=True),
        sa.Column("granted_by", sa.String(32), sa.ForeignKey("account.id", ondelete="SET NULL"), nullable=True),
        sa.Column("granted", TIME, nullable=False),
    )
    op.create_table(
        "device",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column("clinic_id", sa.String(32), sa.ForeignKey("clinic.id"), nullable=False, index=True),
        sa.Column("name", sa.String(64), nullable=False),
        sa.Column("kind", sa.String(32), nullable=False),
        sa.Column("source", sa.String(300), nullable=True),
        sa.Column("note", sa.String(200), nullable=True),
        sa.Column("retired", TIME, nullable=True),
        sa.Column("created", TIME, nullable=False),
    )


def _create_audit() -> None:
    op.create_table(
        "audit_entry",
        sa.Column("number", NUMBER, primary_key=True, autoincrement=False),
        sa.Column("at", TIME, nullable=False, index=True),
        sa.Column("actor_kind", sa.String(16), nullable=False),
        sa.Column("actor", sa.String(32), nullable=True, index=True),
        sa.Column("role", sa.String(16), nullable=True),
        sa.Column("clinic", sa.String(32), nullable=True, index=True),
        sa.Column("action", sa.String(64), nullable=False),
        sa.Column("patient", sa.String(16), nullable=True, index=True),
        sa.Column("session", sa.String(64), nullable=True),
        sa.Column("object", sa.String(120), nullable=True),
        sa.Column("outcome", sa.Integer, nullable=False),
        sa.Column("reason", sa.String(500), nullable=True),
        sa.Column("previous", sa.String(64), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
    )
    head = op.create_table(
        "audit_head",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("number", NUMBER, nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
    )
    op.bulk_insert(head, [{"id": 1, "number": 0, "digest": "0" * 64}])
    _refuse_changes()


def _refuse_changes() -> None:
    # The chain tells a change that was made; this keeps the gateway's own code from making one.
    if op.get_bind().dialect.name == "sqlite":
        for change in ("UPDATE", "DELETE"):
            op.execute(
                f"CREATE TRIGGER audit_no_{change.lower()} BEFORE {change} ON audit_entry "
                "BEGIN SELECT RAISE(ABORT, 'the audit is append-only'); END"
            )
        return
    op.execute(
        "CREATE FUNCTION audit_is_append_only() RETURNS trigger LANGUAGE plpgsql AS "
        "$$ BEGIN RAISE EXCEPTION 'the audit is append-only'; END $$"
    )
    op.execute(
        "CREATE TRIGGER audit_no_change BEFORE UPDATE OR DELETE ON audit_entry "
        "FOR EACH ROW EXECUTE FUNCTION audit_is_append_only()"
    )
