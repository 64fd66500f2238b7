"""Shape the actor's lids, which slide on the eyeballs, and the eyeballs themselves."""

import numpy as np

from data_example.generator import charts, fields

HALF = 28
COUNT = 2 * HALF
RADIUS = 18.5
CENTRES = {"l": np.array([31.5, 0.0, 52.5]), "r": np.array([-31.5, 0.0, 52.5])}
_ANGLE = np.pi * np.arange(COUNT) / HALF
# position along the lids, -1 at the corner on the left of the picture
ALONG = -np.cos(_ANGLE)
LOWER = np.arange(COUNT) <= HALF
CORNER = np.deg2rad(52.0)
GAZE = np.deg2rad((26.0, 20.0))
IRIS = np.deg2rad(24.5)
PUPIL = np.deg2rad(10.5)
# height of the clear dome over the iris [mm]
CORNEA = 0.55
LID_RINGS = (-0.35, 0.0, 0.1, 0.3, 0.55, 0.8, 1.0)
MARGIN = 1


def gaze_angles(p):
    """Return azimuth (to the actor's left) and elevation of the gaze [rad]."""
    return GAZE[0] * p["gaze_x"], GAZE[1] * p["gaze_y"]


def on_sphere(centre, azimuth, elevation, radius):
    """Return points on a sphere about a centre, azimuth to +x, elevation to +y [mm]."""
    flat = np.cos(elevation)
    direction = np.stack(
        [np.sin(azimuth) * flat, np.sin(elevation), np.cos(azimuth) * flat], axis=-1
    )
    return np.asarray(centre) + np.asarray(radius)[..., None] * direction


def lid_angles(side, p):
    """Return azimuth and elevation along the lids' edges, and of the creases, (COUNT,) [rad]."""
    out = 1.0 if side == "l" else -1.0
    s = ALONG
    blink, squint, wide = p[f"blink_{side}"], p["squint"], p["wide"]
    gaze_y = p["gaze_y"]
    skew = 0.12 * out
    arch = np.maximum(1 - s * s, 0) ** 0.72
    upper_arch = arch * (1 - skew * s)
    lower_arch = np.maximum(1 - s * s, 0) ** 0.85 * (1 + 0.8 * skew * s)
    tilt = np.deg2rad(3.0) * out * s
    upper = np.deg2rad(23.5 + 8.0 * wide + 6.0 * gaze_y - 5.0 * squint)
    lower = np.deg2rad(-20.0 - 1.5 * wide + 2.5 * gaze_y + 8.0 * squint)
    # the lid slides on the sphere: the blink is linear in angle, not in the picture
    meet = lower_arch * np.deg2rad(-12.0)
    low = (1 - blink) * lower_arch * lower + blink * meet
    high = (1 - blink) * upper_arch * upper + blink * meet
    edge = tilt + np.where(LOWER, low, high)
    fold = np.maximum(1 - s * s, 0) ** 0.55
    lift = 2.5 * p[f"brow_outer_{side}"] + 1.0 * wide - 3.0 * p["brow_frown"]
    crease = tilt + np.where(LOWER, np.deg2rad(-31.0), np.deg2rad(38.5 + lift)) * fold
    return CORNER * s, edge, CORNER * s * 1.13, crease


def lid_rings(side, p):
    """Return the rings of one eye's lids, (R, COUNT, 3) [mm]; ring MARGIN is the contour."""
    azimuth, edge, crease_azimuth, crease = lid_angles(side, p)
    result = []
    for t in LID_RINGS:
        a = azimuth + max(t, 0) * (crease_azimuth - azimuth)
        e = edge + max(t, 0) * (crease - edge)
        thickness = 1.5 if t >= 0 else 0.15
        bulge = np.where(LOWER, 0.1, 0.7) * np.sin(np.pi * max(t, 0))
        sunk = max(t, 0) ** 6 * np.where(LOWER, 0.0, 1.3)
        # the outer corner stands back a little so that lids wrap round the ball
        radius = RADIUS + thickness + bulge - sunk + 0 * a
        result.append(on_sphere(CENTRES[side], a, e, radius))
    return np.stack(result)


def gaze_axes(p):
    """Return the (3, 3) rotation whose columns carry the ball's x, y, z to the head."""
    azimuth, elevation = gaze_angles(p)
    ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
    turn = np.array([[ca, 0, sa], [0, 1, 0], [-sa, 0, ca]])
    nod = np.array([[1, 0, 0], [0, ce, se], [0, -se, ce]])
    return turn @ nod


def pupil(side, p):
    """Return the centre of the pupil on the ball, (3,) [mm]."""
    return CENTRES[side] + gaze_axes(p) @ np.array([0, 0, RADIUS + CORNEA])


def ball(rings=30, spokes=44):
    """Return an eyeball about the origin with the pupil at +z.

    Returns
    -------
    vertices : (V, 3) float array [mm]
    faces : (F, 3) int array
    polar : (V, 2) float array, angle from the axis and angle round it [rad]
    """
    angles = np.concatenate(
        [np.linspace(0, IRIS * 1.2, rings // 2), np.linspace(IRIS * 1.25, 1.9, rings // 2)]
    )
    around = 2 * np.pi * np.arange(spokes) / spokes
    a, r = np.meshgrid(angles, around, indexing="ij")
    cornea = CORNEA * (1 - fields.smoothstep(0, IRIS * 1.05, a))
    radius = RADIUS + cornea
    vertices = np.stack(
        [radius * np.sin(a) * np.cos(r), radius * np.sin(a) * np.sin(r), radius * np.cos(a)], -1
    )
    index = np.arange(rings * spokes).reshape(rings, spokes)
    faces = charts.strip(index)[:, ::-1]
    return vertices.reshape(-1, 3), faces, np.stack([a, r], -1).reshape(-1, 2)
