"""Tunables of the rhythm estimators.

Sources: [J] Joukov, Rhythmic EKF, section IV; [B] chosen on the motions of `ambula bench rhythm`, with other seeds.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class JoukovParameters:
    """The canonical dynamical system as published; rates are read as per second."""

    harmonics: int = 7
    """[J] for simulation and participants."""
    initial_frequency: float = 5.0
    """rad/s. [J] average walking."""
    frequency_rate: float = 0.7
    """zeta, (rad/s)/s per rad/s of error. [J]."""
    coefficient_rate: float = 0.05
    """eta, 1/s. [J] for participants; 0.2 in its simulation, which also converges faster on synthetic walks."""
    driver: int = 0
    """Channel whose error drives phase and frequency. [J] takes the right knee."""
    largest_frequency: float = 25.0
    """rad/s. Not in [J]: bound of |lambda|, far above any stride, that keeps a run-away finite."""
    largest_velocity: float = 100.0
    """rad/s. Not in [J]: inputs are clipped here; no gyro in use measures more than 70 rad/s."""
    quality_time_s: float = 3.0
    """s. Not in [J]: averaging of the explained share that is reported."""


@dataclass(frozen=True)
class TrustedParameters:
    """The estimator of `trusted.py`, grouped by its steps."""

    # Input
    nominal_interval_s: float = 0.01
    """s between samples; only used for the one sample after a gap."""
    gap_s: float = 0.1
    """s. A longer interval is a gap: the correlator starts again, the phase coasts over at most half a stride."""
    largest_velocity: float = 100.0
    """rad/s. Inputs are clipped here; no gyro in use measures more than 70 rad/s."""

    # Detection filter
    detection_cutoff_hz: float = 5.0
    """Hz of each of two one-pole low-passes. [B]"""
    energy_time_s: float = 3.0
    """s. Averaging of the energies that weigh the channels. [B]"""
    recent_energy_time_s: float = 0.7
    """s. Averaging of the energies a fresh search starts from. [B]"""

    # Correlator
    grid_interval_s: float = 0.04
    """s between correlated values (25 Hz holds five times the 5 Hz of the filter)."""
    lowest_frequency_hz: float = 0.28
    """Hz. Strides below the slowest clinical walking (0.3 Hz) are not searched. [B]"""
    highest_frequency_hz: float = 2.0
    """Hz. Above running strides (1.8 Hz). [B]"""
    memory_lags: float = 2.0
    """Memory of the correlation at a lag, in lags. [B]"""
    shortest_period_share: float = 0.85
    """kappa: the shortest peak of at least this share of the highest is the period. [B] Strides are told from steps
    when the odd harmonics hold more than (1 - kappa) / 2 of the power."""
    seen_lags: float = 1.25
    """A lag is judged after this many lags of data. [B]"""
    searches_every: int = 3
    """Grid points from search to search."""

    # Acceptance
    correlation_to_accept: float = 0.5
    """[B]"""
    candidate_tolerance: float = 0.06
    """Relative change of period that still counts as the same candidate. [B]"""
    candidate_periods: float = 0.4
    """Periods a candidate must stand. [B]"""
    periods_to_lock: float = 2.5
    """Periods of data before any lock. [B]"""
    smallest_rms: float = 0.05
    """rad/s. Below it in every channel nobody walks: no lock on sway or sensor drift."""

    # Waveform
    harmonics: int = 7
    """As [J]. 10 follow a knee's acceleration better."""
    highest_harmonic_hz: float = 9.0
    """Hz. Harmonics above are not learned: the velocity holds noise only. [B]"""
    seed_periods: float = 2.0
    """Periods projected onto the first waveform. [B]"""
    learning_periods: float = 5.0
    """Time constant of the waveform, in periods. [B]"""
    quality_to_learn: float = 0.3
    """Quality at which the waveform begins to learn; full rate at +0.4. [B]"""

    # Phase loop
    damping_gain: float = 1.4
    """Proportional gain over bandwidth: damping 0.7."""
    bandwidth_share: float = 0.3
    """Natural frequency of the loop as a share of the stride frequency. [B]"""
    lowest_bandwidth: float = 0.8
    """rad/s. [B]"""
    calm_variance: float = 0.02
    """rad^2. Variance of the phase error above which the loop narrows, by its fourth root. [B]"""
    narrowest_share: float = 0.3
    """[B]"""
    largest_phase_error: float = 0.7
    """rad. Clip of one sample's phase error. [B]"""
    systematic_error: float = 0.15
    """rad. A mean phase error above widens the loop, to twice its width at +0.3 rad. [B]"""

    # Lock quality and supervision
    quality_periods: float = 1.5
    """Averaging of the quality, and its grace after a seed, in periods. [B]"""
    quality_to_unlock: float = 0.3
    """[B]"""
    quality_to_confirm: float = 0.5
    """Below it the lock stands only while the correlation confirms it. [B]"""
    slip_tolerance: float = 0.05
    """Relative difference of loop and correlation that counts as a slip. [B]"""
    slip_memory: float = 2.5
    """Periods over which the loop's frequency is averaged to be as old as the correlation's: its memory of two lags
    and half a lag between the factors. [B]"""
    slip_periods: float = 1.0
    """Periods a slip must last until the loop is seeded again. [B]"""

    # Stop and restart
    rest_share: float = 0.25
    """Share of the walking RMS below which a channel rests; twice as much ends the rest. [B]"""
    rest_periods: float = 0.45
    """Periods of rest that make a stop. [B]"""
    restart_credit_s: float = 0.3
    """s of motion that went by before a restart is noticed. [B]"""

    # Recognition of a known waveform
    recall_periods: float = 0.75
    """Periods of motion compared with the known waveform, from one or two joints. [B]"""
    recall_joint_periods: float = 2.0
    """Periods times joints that are enough: from four joints half a period. [B]"""
    recall_range: float = 0.25
    """Frequencies tried: within this share of the known one. The edges are not believed. [B]"""
    recall_share: float = 0.8
    """Explained share that is believed. [B]"""
    recall_margin: float = 0.15
    """By how much every phase that is 60 degrees or more away must explain less. [B]"""
    recall_amplitude: float = 2.5
    """Largest ratio of amplitudes, either way. [B]"""
    recall_tolerance: float = 0.35
    """rad. How far two matches in succession may contradict each other. [B]"""
    recall_quality_periods: float = 0.5
    """Averaging of the quality while the lock is provisional, and its grace, in periods. [B]"""
    recall_quality: float = 0.6
    """Quality below which a provisional lock ends. [B]"""
    known_quality: float = 0.75
    """Quality from which on the waveform is kept as known, once a period. [B]"""
    known_periods: float = 3.0
    """Periods in confirmed lock before it is. [B]"""

    # Jerk
    quality_for_jerk: float = 0.5
    """Quality at which the jerk begins to open; fully open at +0.35. [B]"""
