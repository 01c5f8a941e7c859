"""What a therapist reads of a knee session."""

from collections.abc import Sequence

from schemas.vocabulary import Misplacement, Side
from services.estimation.knee.leg import Leg

WRONG_UNITS = "Wrong units: at rest 9.8 m/s2 is expected, measured {values}"

MISPLACED = {
    Misplacement.SWAPPED: "Thigh and shank sensors{leg} seem to be swapped: change them or assign them anew",
    Misplacement.THIGH_UPSIDE_DOWN: "The thigh sensor{leg} seems to be upside down: turn it round",
    Misplacement.SHANK_UPSIDE_DOWN: "The shank sensor{leg} seems to be upside down: turn it round",
    Misplacement.OTHER_LEG: "The sensors{leg} seem to be worn on the {other} leg: change them or assign them anew",
}


def misplacement_words(legs: Sequence[Leg]) -> list[str]:
    """One sentence for each misplacement that is named."""
    sentences = []
    for leg in legs:
        words = {"leg": _of_leg(leg.worn.side, legs), "other": leg.worn.side.other.value}
        sentences += [MISPLACED[kind].format(**words) for kind in leg.misplaced]
    return sentences


def wishes(legs: Sequence[Leg]) -> str:
    """What the person should do now; empty once every leg is believed."""
    waiting = [leg for leg in legs if not leg.is_settled and not leg.is_swapped]
    if not waiting:
        return ""
    wish = waiting[0].estimator.wish
    return f"{wish} ({waiting[0].worn.side})" if len(waiting) < len(legs) else wish


def _of_leg(side: Side, legs: Sequence[Leg]) -> str:
    return f" of the {side} leg" if len(legs) > 1 else ""
