"""Sessions of synthetic patients through the whole chain, to their final metrics."""

from schemas.metrics import SessionMetrics
from services.cli.assembly import build_chain
from services.ingest.source import iter_messages, open_source

TICKS = 10
"""Samples of each message; how they are batched decides nothing."""


def measured_metrics(query: str, estimator: str) -> SessionMetrics:
    """The last message of `metrics` of `synthetic:walk?{query}`."""
    source = open_source(f"synthetic:walk?{query}", estimator=estimator)
    chain = build_chain(source.describe())
    told = [message.payload for each in iter_messages(source, TICKS) for message in chain.push(each)]
    return [payload for payload in told if isinstance(payload, SessionMetrics)][-1]
