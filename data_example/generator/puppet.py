"""Rig the puppet: no mesh, only named controls, as an animation program has them."""

import numpy as np

from data_example.generator import features

GAINS = features.Gains(jaw=1.1)
MOUTH = (
    "jaw_turn_deg jaw_side_cm lip_width_cm lip_gap_cm lip_push_cm corner_l_cm corner_r_cm lip_roll"
)
EYES = "brow_l_cm brow_r_cm brow_tilt_l_deg brow_tilt_r_deg lid_l lid_r lid_low_l lid_low_r"
PUPILS = "eyes_yaw_deg eyes_pitch_deg"
REGIONS = {"mouth": MOUTH.split(), "eyes": EYES.split(), "pupils": PUPILS.split()}
NAMES = tuple(name for names in REGIONS.values() for name in names)


def controls(p):
    """Return the values of the controls, (N,) float array in the order of NAMES."""
    along = np.array([-1.0, 0.0, 1.0])
    upper, lower = features.lips(p, along, GAINS)
    value = {
        "jaw_turn_deg": 24 * p["jaw_open"],
        "jaw_side_cm": 0.8 * p["jaw_side"],
        "lip_width_cm": 2.5 * (upper[2, 0] - upper[0, 0]),
        "lip_gap_cm": 2.5 * (upper[1, 1] - lower[1, 1]),
        "lip_push_cm": 1.2 * features.forward(p),
        "corner_l_cm": 2.5 * upper[2, 1],
        "corner_r_cm": 2.5 * upper[0, 1],
        "lip_roll": p["press"],
        "eyes_yaw_deg": 30 * p["gaze_x"],
        "eyes_pitch_deg": 22 * p["gaze_y"],
    }
    for side in ("l", "r"):
        ends = features.brow(p, side, np.array([0.0, 1.0]))[:, 1]
        value[f"brow_{side}_cm"] = 2.4 * ends.mean()
        value[f"brow_tilt_{side}_deg"] = np.rad2deg(np.arctan2(ends[1] - ends[0], 1))
        value[f"lid_{side}"], value[f"lid_low_{side}"] = features.lid_heights(p, side)
    return np.array([value[name] for name in NAMES])


def masks():
    """Return the rows of the puppet's masks table."""
    rows = [f"{name}\t{region}\t1" for region, names in REGIONS.items() for name in names]
    return ["vertex\tregion\tweight", *rows]
