"""Name the expression parameters of the actor and the region that each one moves."""

import numpy as np

MOUTH = (
    "jaw_open",
    "jaw_side",
    "lip_close",
    "pucker",
    "funnel",
    "smile_l",
    "smile_r",
    "stretch",
    "frown",
    "upper_up",
    "lower_down",
    "press",
    "tongue_up",
)
EYES = (
    "brow_inner_l",
    "brow_inner_r",
    "brow_outer_l",
    "brow_outer_r",
    "brow_frown",
    "blink_l",
    "blink_r",
    "squint",
    "wide",
)
PUPILS = ("gaze_x", "gaze_y")
NAMES = MOUTH + EYES + PUPILS
REGIONS = {"mouth": MOUTH, "eyes": EYES, "pupils": PUPILS}
SIGNED = ("jaw_side", "gaze_x", "gaze_y")


def neutral():
    """Return the parameters of the neutral face, all zero."""
    return dict.fromkeys(NAMES, 0.0)


def from_row(row):
    """Return a row of a (T, N) parameter table as a dictionary by name."""
    return {name: float(value) for name, value in zip(NAMES, row, strict=True)}


def only(values, region):
    """Return the parameters with those of all other regions set to zero."""
    return {name: values[name] if name in REGIONS[region] else 0.0 for name in NAMES}


def limited(table):
    """Return a (T, N) parameter table clipped to 0..1, or -1..1 for the signed ones."""
    low = np.array([-1.0 if name in SIGNED else 0.0 for name in NAMES])
    return np.clip(table, low, 1.0)
