"""The table of routers: everything that the gateway answers to below /v1, live connections and /metrics included."""

from services.gateway.accounts.administration import router as administration
from services.gateway.accounts.oidc.routes import router as oidc
from services.gateway.accounts.own import router as own_account
from services.gateway.accounts.routes import router as accounts
from services.gateway.audit.routes import router as audit
from services.gateway.clinics.routes import router as clinics
from services.gateway.devices.routes import router as devices
from services.gateway.directory.routes import router as names
from services.gateway.erasure.routes import router as erasure
from services.gateway.exports.routes import router as exports
from services.gateway.fhir.routes import router as fhir
from services.gateway.health.routes import router as health
from services.gateway.keys.routes import router as keys
from services.gateway.live.routes import router as live_routes
from services.gateway.monitoring.routes import router as monitoring
from services.gateway.patients.record_routes import router as records
from services.gateway.patients.routes import router as patients
from services.gateway.progress.routes import router as progress
from services.gateway.recordings.routes import router as recordings
from services.gateway.recycling.routes import router as recycling
from services.gateway.references.routes import router as references
from services.gateway.replay.routes import router as replay
from services.gateway.report.routes import router as reports
from services.gateway.roster.routes import router as roster
from services.gateway.sessions.routes import router as sessions
from services.gateway.sharing.routes import router as sharing
from services.gateway.sources.routes import router as sources
from services.gateway.treatments.routes import router as treatments
from services.gateway.versions.routes import router as versions
from services.gateway.visits.routes import router as visits

ROUTERS = (
    accounts,
    own_account,
    oidc,
    administration,
    clinics,
    keys,
    devices,
    sharing,
    audit,
    patients,
    names,
    recycling,
    erasure,
    records,
    roster,
    visits,
    progress,
    treatments,
    references,
    reports,
    sessions,
    recordings,
    replay,
    exports,
    versions,
    fhir,
    sources,
    health,
    live_routes,
    monitoring,
)

ROUTES = [route for router in ROUTERS for route in router.routes]
