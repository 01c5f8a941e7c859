"""What may be noted as done for a patient: a fixed vocabulary, for free text could identify somebody."""

from enum import StrEnum


class TreatmentKind(StrEnum):
    """Shown as marks beside the progress; no verdict rests on them."""

    GAIT_TRAINING = "gait_training"
    TREADMILL_TRAINING = "treadmill_training"
    ROBOT_TRAINING = "robot_training"
    STRENGTH_TRAINING = "strength_training"
    BALANCE_TRAINING = "balance_training"
    ELECTRICAL_STIMULATION = "electrical_stimulation"
    BOTULINUM_TOXIN = "botulinum_toxin"
    MEDICATION_CHANGE = "medication_change"
    AID_CHANGE = "aid_change"
    ORTHOSIS_CHANGE = "orthosis_change"
    SURGERY = "surgery"
    PAUSE = "pause"
    OTHER = "other"
