"""The likeliest run of trust and mistrust through a series, of many series at once (Viterbi)."""

import numpy as np

LEAP = 1.5


def trace(doubt: np.ndarray, step: np.ndarray, switch: float) -> np.ndarray:
    """Find where series are bad: minimise the cost of states over time.

    A good frame costs `doubt` and, after a good one, `step`; a bad frame after a bad one costs no
    more than one and a half changes of state for its step: a series that leaps is likelier to
    come back than to leap on. A change of state, and a bad first frame, cost `switch`.

    Parameters
    ----------
    doubt : (T, P) float array, cost of taking a frame for good less that of taking it for bad
    step : (T, P) float array, cost of taking a frame and the one before for good
    switch : cost of a change of state

    Returns
    -------
    (T, P) bool array, True where the series is bad

    Raises
    ------
    ValueError
        if the shapes differ
    """
    if doubt.shape != step.shape:
        raise ValueError(f"expected equal shapes, got {doubt.shape} and {step.shape}")
    good, bad = doubt[0].astype(float), np.full(doubt.shape[1], switch)
    from_bad, from_good = np.zeros(doubt.shape, bool), np.zeros(doubt.shape, bool)
    for t in range(1, len(doubt)):
        stay, enter = good + step[t], bad + switch
        remain, leave = bad + np.minimum(step[t], LEAP * switch), good + switch
        from_bad[t], from_good[t] = enter < stay, leave < remain
        good, bad = np.minimum(stay, enter) + doubt[t], np.minimum(remain, leave)
    states = np.zeros(doubt.shape, bool)
    states[-1] = bad < good
    for t in range(len(doubt) - 1, 0, -1):
        states[t - 1] = np.where(states[t], ~from_good[t], from_bad[t])
    return states
