"""The 46 shapes of the clay head, named as in ARKit, and what the performance asks of them.

Left and right are the character's own.
"""

import numpy as np

from data_example.generator import clay, fields, params

SIDES = (("Left", "l", 1.0), ("Right", "r", -1.0))
# shapes of one parameter, and those whose halves are two shapes
WHOLE = {
    "jawOpen": "jaw_open=1",
    "jawLeft": "jaw_side=1",
    "jawRight": "jaw_side=-1",
    "mouthFunnel": "funnel=1",
    "mouthPucker": "pucker=1",
    "browInnerUp": "brow_inner_l=1 brow_inner_r=1",
}
HALVES = {
    "mouthSmile": "smile_l=1 smile_r=1",
    "mouthFrown": "frown=1",
    "mouthStretch": "stretch=1",
    "mouthUpperUp": "upper_up=1",
    "mouthLowerDown": "lower_down=1",
    "mouthPress": "press=1",
    "browDown": "brow_frown=1",
    "browOuterUp": "brow_outer_l=1 brow_outer_r=1",
    "eyeBlink": "blink_l=1 blink_r=1",
    "eyeSquint": "squint=1",
    "eyeWide": "wide=1",
    "eyeLookUp": "gaze_y=1",
    "eyeLookDown": "gaze_y=-1",
}
# what moves less than this [mm] does not move at all
LEAST_MM = 0.12
NAMES = (
    "browDownLeft", "browDownRight", "browInnerUp", "browOuterUpLeft", "browOuterUpRight",
    "cheekSquintLeft", "cheekSquintRight", "eyeBlinkLeft", "eyeBlinkRight", "eyeLookDownLeft",
    "eyeLookDownRight", "eyeLookInLeft", "eyeLookInRight", "eyeLookOutLeft", "eyeLookOutRight",
    "eyeLookUpLeft", "eyeLookUpRight", "eyeSquintLeft", "eyeSquintRight", "eyeWideLeft",
    "eyeWideRight", "jawLeft", "jawOpen", "jawRight", "mouthClose", "mouthFrownLeft",
    "mouthFrownRight", "mouthFunnel", "mouthLeft", "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthPressLeft", "mouthPressRight", "mouthPucker", "mouthRight", "mouthRollLower",
    "mouthRollUpper", "mouthShrugLower", "mouthSmileLeft", "mouthSmileRight", "mouthStretchLeft",
    "mouthStretchRight", "mouthUpperUpLeft", "mouthUpperUpRight", "noseSneerLeft",
    "noseSneerRight",
)  # fmt: skip


def _stack(pieces):
    """Return all pieces in one table, (V, 3) [mm]."""
    return np.concatenate(list(pieces.values()))


def _posed(rest, text, **rolls):
    """Return the vertices under a written pose, (V, 3) [mm]."""
    p = params.neutral()
    p |= {name: float(v) for name, v in (entry.split("=") for entry in text.split())}
    return _stack(clay.pose(rest, p, **rolls))


def deltas(rest):
    """Return the shapes' displacements of the moving pieces, name -> (V, 3) [mm]."""
    neutral = _posed(rest, "")
    result = {name: _posed(rest, text) - neutral for name, text in WHOLE.items()}
    for name, text in HALVES.items():
        whole = _posed(rest, text) - neutral
        for side, _, out in SIDES:
            share = fields.smoothstep(-9.0, 9.0, out * neutral[:, 0])
            result[name + side] = share[:, None] * whole
    for side, inward in (("Left", -1), ("Right", 1)):
        out = 1.0 if side == "Left" else -1.0
        share = (out * neutral[:, 0] > 0)[:, None]
        for name, way in (("eyeLookIn", inward), ("eyeLookOut", -inward)):
            result[name + side] = share * (_posed(rest, f"gaze_x={way}") - neutral)
    shut = _posed(rest, "jaw_open=1 lip_close=1") - _posed(rest, "jaw_open=1")
    result["mouthClose"] = shut
    result["mouthRollUpper"] = _posed(rest, "", roll_upper=1.0) - neutral
    result["mouthRollLower"] = _posed(rest, "", roll_lower=1.0) - neutral
    result |= _by_hand(neutral)
    for name, delta in result.items():
        small = np.linalg.norm(delta, axis=1) < LEAST_MM
        result[name] = np.where(small[:, None], 0.0, delta)
    return {name: result[name] for name in NAMES}


def _by_hand(neutral):
    """Return the shapes that are modelled directly, name -> (V, 3) [mm]."""
    result = {}
    front = fields.smoothstep(34, 62, neutral[:, 2])
    mouth = fields.bell(neutral, clay.MOUTH, (44, 22, 60)) * front
    for side, _, out in SIDES:
        result["mouth" + side] = mouth[:, None] * [out * 9.0, 0, -1.0]
        cheek = fields.bell(neutral, (out * 44, -22, 70), (24, 13, 45)) * front
        result["cheekSquint" + side] = cheek[:, None] * [out * 0.8, 7.0, 4.0]
        wing = fields.bell(neutral, (out * 11, -20, 92), (11, 14, 24)) * front
        result["noseSneer" + side] = wing[:, None] * [out * 1.2, 4.5, -0.8]
    chin = fields.bell(neutral, (0, -84, 72), (30, 18, 40)) * front
    result["mouthShrugLower"] = chin[:, None] * [0, 6.5, 3.5]
    return result


def _positive(value):
    """Return what of a signed parameter is positive, without a kink."""
    return np.maximum((value + np.sqrt(value * value + 0.01)) / 2 - 0.05, 0)


def weights(table):
    """Return the true weights of the shapes for expressions of the actresses.

    Parameters
    ----------
    table : (T, N) float array, columns params.NAMES

    Returns
    -------
    weights : (T, 46) float array in 0..1, columns NAMES
    """
    p = {name: np.asarray(table)[:, i] for i, name in enumerate(params.NAMES)}
    jaw = 1 - (1 - p["jaw_open"]) ** 1.15
    apart = 1 - p["lip_close"]
    aside = p["jaw_side"]
    w = {
        "jawOpen": jaw,
        "jawLeft": _positive(aside),
        "jawRight": _positive(-aside),
        "mouthClose": jaw * p["lip_close"],
        "mouthFunnel": p["funnel"] * (1 - 0.3 * p["lip_close"]),
        "mouthPucker": p["pucker"],
        "mouthLeft": 0.3 * _positive(aside) + 0.25 * _positive(p["smile_l"] - p["smile_r"]),
        "mouthRight": 0.3 * _positive(-aside) + 0.25 * _positive(p["smile_r"] - p["smile_l"]),
        "mouthRollLower": 0.7 * p["press"],
        "mouthRollUpper": 0.5 * p["press"] * p["lip_close"],
        "mouthShrugLower": np.minimum(0.45 * p["frown"] + 0.2 * p["press"], 1),
        "browInnerUp": (p["brow_inner_l"] + p["brow_inner_r"]) / 2 * (1 - 0.2 * p["brow_frown"]),
    }
    for side, s, out in SIDES:
        smile, blink = p[f"smile_{s}"], p[f"blink_{s}"]
        w |= {
            "mouthSmile" + side: smile * (1 - 0.35 * p["pucker"]),
            "mouthFrown" + side: p["frown"],
            "mouthStretch" + side: 0.9 * p["stretch"],
            "mouthUpperUp" + side: 0.85 * p["upper_up"] * (1 - 0.8 * p["lip_close"]),
            "mouthLowerDown" + side: p["lower_down"] * apart,
            "mouthPress" + side: 0.8 * p["press"],
            "noseSneer" + side: p["upper_up"] * (0.25 + 0.7 * p["brow_frown"]),
            "cheekSquint" + side: np.minimum(0.55 * smile + 0.45 * p["squint"], 1),
            "browDown" + side: p["brow_frown"] * (1 - 0.35 * p[f"brow_inner_{s}"]),
            "browOuterUp" + side: p[f"brow_outer_{s}"],
            "eyeBlink" + side: blink,
            "eyeSquint" + side: p["squint"] * (1 - blink),
            "eyeWide" + side: p["wide"] * (1 - blink),
            "eyeLookUp" + side: _positive(p["gaze_y"]),
            "eyeLookDown" + side: _positive(-p["gaze_y"]),
            "eyeLookOut" + side: _positive(out * p["gaze_x"]),
            "eyeLookIn" + side: _positive(-out * p["gaze_x"]),
        }
    return np.clip(np.stack([w[name] for name in NAMES], axis=1), 0, 1)
