"""Model the tortoise's skin: one tube from the throat over beak, head and neck into the shell.

It is modelled in centimetres, the head's middle at the origin. Every ring of the tube runs from
the right corner of the mouth along its lower side to the left one, and back along the upper side.
The head stays where it is in every pose, and the shell moves towards it or away from it: were the
head to move, a mouth half led by the words would hang behind it.
"""

import numpy as np

from data_example.generator import fields

COLUMNS = 24
ANGLE = 2 * np.pi * np.arange(COLUMNS) / COLUMNS
ACROSS, HIGH = -np.cos(ANGLE), -np.sin(ANGLE)
LOWER = np.arange(COLUMNS) <= COLUMNS // 2
# 0 at the corners of the mouth, 1 in its middle
ARCH = np.maximum(1 - np.abs(ACROSS) ** 3.2, 0) ** 0.7
# columns at the corners belong to both jaws
JAW_SIDE = np.where(LOWER, fields.smoothstep(0.0, 0.5, -HIGH), 0.0)
HINGE = np.array([0.0, -0.6, -1.5])
OPEN = np.deg2rad(25.0)
HALF, TIP, BACK = 5.3, 9.6, 6.4
# rings of the mouth before those of the table: throat, bag, inside, edge, rim
MOUTH = 5
EDGE, RIM = 3, 4
# upper and lower point of each ring in the middle plane (y, z), half width, how far its sides lag
RINGS = np.array([
    (1.5, 9.85, -1.45, 9.0, 5.55, 5.7), (3.4, 8.7, -2.9, 7.7, 6.0, 5.0),
    (5.0, 6.7, -3.8, 5.6, 6.5, 4.0), (6.5, 3.8, -4.4, 3.4, 6.95, 2.8),
    (7.4, 0.6, -4.9, 1.6, 7.05, 1.6), (7.2, -2.6, -5.5, 0.2, 6.7, 0.6),
    (5.8, -5.2, -6.3, -0.8, 5.9, 0.0), (3.4, -6.7, -7.3, -1.5, 5.0, 0.0),
    (1.0, -7.1, -8.3, -1.9, 4.5, 0.0), (-1.0, -7.1, -9.3, -2.0, 4.3, 0.0),
    (-2.9, -7.1, -10.4, -2.2, 4.3, 0.0), (-4.8, -7.3, -11.8, -2.6, 4.4, 0.0),
    (-6.7, -8.2, -13.3, -3.8, 4.6, 0.0), (-8.4, -10.6, -14.8, -6.6, 4.9, 0.0),
    (-9.6, -15.0, -15.8, -11.5, 5.2, 0.0),
])  # fmt: skip
# how much of the beak's own movement, of the jaw's turn and of the shell's way each ring follows
PULL = np.array([0.88, 0.55, 0.25, 0.08, *[0.0] * 11])
JAW = np.array([1.0, 0.97, 0.88, 0.72, 0.50, 0.28, 0.12, 0.04, *[0.0] * 7])
NECK = np.array([*[0.0] * 5, 0.02, 0.07, 0.16, 0.27, 0.40, 0.53, 0.67, 0.82, 0.94, 1.0])
WRINKLE = np.array([*[0.0] * 6, -0.05, 0.16, -0.30, 0.30, -0.32, 0.30, -0.28, 0.22, 0.0])
# what a pose may set; all are 0 in the neutral
NAMES = (
    "jaw", "aside", "smile_l", "smile_r", "spread", "pucker", "round", "lift", "drop", "press",
    "tuck", "sneer_l", "sneer_r", "cheek_l", "cheek_r", "gular", "tongue", "lick",
    "blink_l", "blink_r", "lid_l", "lid_r", "under_l", "under_r", "slant", "gaze_x", "gaze_y",
    "inner_l", "inner_r", "outer_l", "outer_r", "knit", "neck", "reach", "lean", "puff",
)  # fmt: skip


def pose_of(text=""):
    """Return the pose that a text such as `jaw=0.5 smile=0.8` writes, by name.

    A name without its `_l` or `_r` sets both sides.
    """
    p = dict.fromkeys(NAMES, 0.0)
    for entry in text.split():
        name, _, value = entry.partition("=")
        sides = (name,) if name in p else (f"{name}_l", f"{name}_r")
        if not set(sides) <= set(p):
            raise ValueError(f"a tortoise has no '{name}'")
        p |= dict.fromkeys(sides, float(value))
    return p


def jaw(points, p):
    """Return the displacement of what is fixed to the lower jaw [cm]."""
    angle, side = OPEN * p["jaw"], np.deg2rad(9.0) * p["aside"]
    q = points - HINGE
    y = q[..., 1] * np.cos(angle) - q[..., 2] * np.sin(angle)
    z = q[..., 1] * np.sin(angle) + q[..., 2] * np.cos(angle)
    return np.stack([q[..., 0] + z * np.sin(side), y, z * np.cos(side)], axis=-1) - q


def edge(p):
    """Return the edge of the beak, where upper and lower meet when it is shut, (COLUMNS, 3)."""
    s, end = ACROSS, np.abs(ACROSS) ** 2.2
    left = fields.smoothstep(-0.35, 0.35, s)
    smile = p["smile_r"] + left * (p["smile_l"] - p["smile_r"])
    narrow = 0.46 * p["pucker"] + 0.22 * p["round"]
    half = HALF * (1 - narrow + 0.10 * p["spread"])
    x = s * half + np.sign(s) * end * 0.45 * np.maximum(smile, 0)
    y = 0.6 * end + 2.1 * end * smile - 0.25 * np.maximum(smile, 0) - 0.3 * (1 - end)
    forward = 2.2 * p["pucker"] + 1.1 * p["round"]
    z = TIP - BACK * (1 - 0.30 * narrow) * s * s + forward * (1 - 0.55 * s * s)
    z = z - 0.5 * p["spread"] * end
    line = np.stack([x, y, z], axis=1)
    turned = line + (0.30 + 0.70 * ARCH)[:, None] * jaw(line, p)
    # the corners give way to both jaws alike, so that the two edges end in one point
    corner = line + 0.30 * jaw(line, p)
    upper = corner + ARCH[:, None] * (line - corner)
    upper[:, 1] += ARCH * (0.9 * p["lift"] + 0.8 * p["round"])
    sneer = p["sneer_r"] + left * (p["sneer_l"] - p["sneer_r"])
    upper[:, 1] += 1.3 * sneer * ARCH * np.abs(s) ** 0.8 * (1 - 0.2 * s * s)
    turned[:, 1] -= ARCH * (0.9 * p["drop"] + 0.8 * p["round"])
    turned += (ARCH * p["tuck"])[:, None] * [0, 0.5, -1.1]
    return np.where(LOWER[:, None], turned, upper)


def mouth(p):
    """Return the mouth's rings from the throat to the beak's rim, (MOUTH, COLUMNS, 3) [cm]."""
    on = edge(p)
    sign = np.where(LOWER, -1.0, 1.0)
    end = np.maximum(1 - ACROSS**6, 0) ** 0.6
    hook = np.exp(-((ACROSS / 0.24) ** 2)) * ~LOWER * (1 - 0.6 * min(p["round"] + p["pucker"], 1))
    # the upper beak hangs over the lower one, most of all at its hook
    over = np.where(LOWER, -0.10, -0.22 - 0.55 * hook - 0.30 * p["press"])
    out = np.where(LOWER, 0.22 - 0.2 * p["press"], 0.55 + 0.25 * hook + 0.15 * p["press"])
    rim = on + np.column_stack([0.10 * ACROSS * end, over * end, out * (0.4 + 0.6 * end)])
    low = on[LOWER].mean(axis=0)
    inside = on + np.column_stack([-0.3 * ACROSS, 0.5 * sign * end, 0 * end - 1.2])
    bag = np.column_stack([0.78 * on[:, 0], on[:, 1] + 1.2 * sign * end, 0.55 * on[:, 2] - 0.2])
    throat = np.array([0.0, 0.5 * low[1] - 0.4, 0.6])
    throat = throat + 0.03 * (bag - bag.mean(axis=0))
    return np.stack([throat, bag, inside, on, rim])


def _table():
    """Return the rings of head and neck at rest, wrinkles included, (R, COLUMNS, 3) [cm]."""
    top, bottom = RINGS[:, None, :2], RINGS[:, None, 2:4]
    power = 2 / 2.25
    x = np.sign(ACROSS) * np.abs(ACROSS) ** power
    u = np.sign(HIGH) * np.abs(HIGH) ** power
    flat = (top + bottom) / 2 + u[:, None] * (top - bottom) / 2
    # around the mouth the sides meet its corners
    flat[..., 1] -= RINGS[:, 5:6] * x**2
    rows = np.stack([RINGS[:, 4:5] * x, flat[..., 0], flat[..., 1]], axis=-1)
    middle = rows.mean(axis=1, keepdims=True)
    return rows + WRINKLE[:, None, None] * (rows - middle) / 4.5


class Rest:
    """The skin in its neutral pose, and its faces."""

    def __init__(self):
        self.table = _table()
        self.mouth = mouth(pose_of())
        self.rows = MOUTH + len(RINGS)
        self.jaw = JAW[:, None] * JAW_SIDE


def shell_way(p):
    """Return how the shell moves under the still head, (3,) [cm]: a long neck takes it down."""
    return np.array([-2.0 * p["lean"], -4.2 * p["neck"], -2.6 * p["reach"]])


def _bulges(points, p):
    """Return the displacement of cheeks, throat and nostrils [cm]."""
    move = np.zeros_like(points)
    for side, name in ((1, "l"), (-1, "r")):
        cheek = fields.bell(points, (side * 6.4, -0.4, 3.2), (3.0, 2.4, 3.6))
        move += p[f"cheek_{name}"] * cheek[..., None] * [side * 0.9, 0.7, 0.5]
        wing = fields.bell(points, (side * 2.6, 2.6, 8.6), (2.2, 1.6, 2.5))
        move += p[f"sneer_{name}"] * wing[..., None] * [side * 0.1, 0.8, 0.25]
    throat = fields.bell(points, (0, -6.0, 0.6), (4.0, 2.6, 3.5))
    return move + p["gular"] * throat[..., None] * [0, -1.4, 0.9]


def skin(rest, p):
    """Return the skin's vertices, (rows * COLUMNS, 3) [cm]."""
    inner = mouth(p)
    table = rest.table + rest.jaw[..., None] * jaw(rest.table, p)
    own = inner[RIM] - rest.mouth[RIM] - JAW_SIDE[:, None] * jaw(rest.mouth[RIM], p)
    table = table + PULL[:, None, None] * own + _bulges(rest.table, p)
    way, middle = shell_way(p), table.mean(axis=1, keepdims=True)
    girth = 1 - 0.13 * p["neck"] + 0.14 * p["puff"]
    wide = 1 + (girth - 1) * np.sin(np.pi * np.minimum(NECK * 1.25, 1)) ** 0.5
    # a long neck has its wrinkles smoothed out, a short one folds deeper
    crease = np.maximum(-0.75 * p["neck"], -0.8) * WRINKLE / 4.5
    table = middle + (wide + crease)[:, None, None] * (table - middle)
    table = table + NECK[:, None, None] * way
    return np.concatenate([inner, table]).reshape(-1, 3)


def under_nose(side):
    """Return the two vertices of skin under a nostril, and its share of the way between them."""
    first = MOUTH * COLUMNS + 3 * COLUMNS // 4 + side
    return first, first + COLUMNS, 0.62


def nose(posed, side):
    """Return a nostril, a small oval that lies on the posed skin, (6, 3) [cm]."""
    first, second, share = under_nose(side)
    middle = posed[first] + share * (posed[second] - posed[first]) + [0, 0.02, 0.10]
    angle = np.pi * np.arange(6) / 3
    oval = np.column_stack([0.34 * np.cos(angle), 0.26 * np.sin(angle), 0 * angle])
    oval[:, 2] = -0.30 * oval[:, 1] - 0.22 * side * oval[:, 0]
    return middle + oval
