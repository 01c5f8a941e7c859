"""What an administrator may do with which account.

Those of a clinic have its accounts, and never one that stands above them: whoever could set the password of a site
administrator would be one.
"""

from http import HTTPStatus

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from services.gateway.access import sign_ins
from services.gateway.access.caller import Caller
from services.gateway.access.roles import Role
from services.gateway.access.tables import AccountRow, SignInRow
from services.gateway.accounts.account_models import AccountChange
from services.gateway.accounts.records import count_site_admins, get_account
from services.gateway.problems import Problem, not_found
from services.gateway.tables import ClinicRow


class OnlySiteAdmins(Problem):
    """A clinic's administrator reaches for what is the site's."""

    def __init__(self) -> None:
        super().__init__(
            HTTPStatus.FORBIDDEN,
            "Only an administrator of the whole site may do this.",
            "Ask one of them.",
        )


def list_accounts(database: Session, caller: Caller, offset: int, limit: int) -> tuple[int, list[AccountRow]]:
    """Number of the accounts that are the caller's to manage, and some of them, by login."""
    where = [] if caller.site_admin else [AccountRow.clinic_id == caller.clinic]
    total = database.scalar(select(func.count()).select_from(AccountRow).where(*where)) or 0
    order = select(AccountRow).where(*where).order_by(func.lower(AccountRow.login), AccountRow.id)
    return total, list(database.scalars(order.offset(offset).limit(limit)))


def count_browsers(database: Session, accounts: list[str]) -> dict[str, int]:
    """Sign-ins of each of the accounts; those without any are missing."""
    counted = (
        select(SignInRow.account_id, func.count())
        .where(SignInRow.account_id.in_(accounts))
        .group_by(SignInRow.account_id)
    )
    return {row[0]: row[1] for row in database.execute(counted)}


def clinic_for(database: Session, caller: Caller, wished: str | None) -> str:
    """The clinic of a new account. Raises a 403 problem, or a 409 one when there is no such clinic."""
    if wished is None or wished == caller.clinic:
        return caller.clinic
    if not caller.site_admin:
        raise OnlySiteAdmins
    if database.get(ClinicRow, wished) is None:
        raise Problem(HTTPStatus.CONFLICT, "There is no such clinic.", "List what exists with GET /v1/clinics.")
    return wished


def check_site_admin(caller: Caller, role: Role, site_admin: bool) -> None:
    """Raises a problem when the flag is not the caller's to change, or does not fit the role."""
    if not caller.site_admin:
        raise OnlySiteAdmins
    if site_admin and role is not Role.ADMIN:
        raise Problem(
            HTTPStatus.CONFLICT,
            "An administrator of the site has the role admin.",
            "Change role and site_admin together.",
        )


def get_another(database: Session, caller: Caller, account: str) -> AccountRow:
    """Somebody else's account that the caller may manage. Raises 404, 403 or 409 problems.

    The caller is read again: two administrators may be closing each other's accounts at this moment.
    """
    myself = database.get(AccountRow, caller.account)
    row = get_account(database, account)
    if row.clinic_id != caller.clinic and not caller.site_admin:
        raise not_found("account", account)
    if row.id == caller.account:
        raise Problem(
            HTTPStatus.CONFLICT,
            "Your own account is changed by another administrator.",
            "Your password: PUT /v1/me/password.",
        )
    lost = myself is None or myself.disabled or myself.role != Role.ADMIN or myself.site_admin != caller.site_admin
    if lost or (row.site_admin and not caller.site_admin):
        raise OnlySiteAdmins
    return row


def change(database: Session, caller: Caller, row: AccountRow, wish: AccountChange) -> None:
    """Apply what is wished. Raises 403 and 409 problems."""
    if wish.clinic is not None and wish.clinic != row.clinic_id:
        if not caller.site_admin:
            raise OnlySiteAdmins
        row.clinic_id = clinic_for(database, caller, wish.clinic)
    could_manage_the_site = row.site_admin and not row.disabled
    role = Role(wish.role or row.role)
    site_admin = row.site_admin if wish.site_admin is None else wish.site_admin
    if site_admin or site_admin != row.site_admin:
        check_site_admin(caller, role, site_admin)
    row.role, row.site_admin = role, site_admin
    if wish.disabled is not None:
        row.disabled = wish.disabled
    database.flush()
    if could_manage_the_site and count_site_admins(database) == 0:
        raise Problem(HTTPStatus.CONFLICT, "This is the last administrator of the site.", "Make another one before.")
    if row.disabled:
        sign_ins.end_all(database, row.id)
