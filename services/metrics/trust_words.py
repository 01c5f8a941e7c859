"""Why a number is withheld, in one line of English. Screens in other languages say it from the doubt."""

from schemas.metrics import Doubt, DoubtKind


def withheld_line(doubt: Doubt) -> str:
    """The sentence for the doubt that decided."""
    value, limit = doubt.value or 0.0, doubt.limit or 0.0
    subject = (doubt.subject or "").replace("_", " ")
    match doubt.kind:
        case DoubtKind.LOSS:
            return f"{value:.0%} of the samples of {subject} were not used; at most {limit:.0%}"
        case DoubtKind.COVERAGE:
            return f"every joint was seen in {value:.0%} of the time; at least {limit:.0%}"
        case DoubtKind.REJECTED_CYCLES:
            foot = f" of the {subject} foot" if subject else ""
            return f"{value:.0%} of the strides{foot} were rejected; at most {limit:.0%}"
        case DoubtKind.FEW_CYCLES:
            return f"{value:.0f} of at least {limit:.0f} strides"
        case DoubtKind.MISPLACED:
            return f"{subject} is worn otherwise than declared"
    return f"{doubt.kind.value.replace('_', ' ')}: {value:g}, limit {limit:g}"
