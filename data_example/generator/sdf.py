"""Describe the actor's head and hair as smooth unions of simple solids.

Millimetres; x to the actor's left, y up, z out of the face; the pupils stand at y = 0.
"""

import numpy as np

from data_example.generator import fields, solids

CENTRE = np.array([0.0, -22.0, 0.0])


def head(points):
    """Return the signed distance [mm] to the skin, mouth and eyes closed over."""
    mirrored = points * [1, 1, 1]
    mirrored[..., 0] = np.abs(points[..., 0])
    p = mirrored
    d = solids.ellipsoid(p, (0, 32, -10), (73, 82, 92))
    d = solids.join(d, solids.ellipsoid(p, (0, -22, 14), (62, 74, 66)), 24)
    d = solids.join(d, solids.ellipsoid(p, (0, -93, 54), (19, 20, 27)), 26)
    d = solids.join(d, solids.capsule(p, (50, -40, -2), (15, -94, 47), 16, 13), 26)
    d = solids.join(d, solids.ellipsoid(p, (37, -30, 49), (26, 22, 27)), 22)
    d = solids.join(d, solids.capsule(p, (10, 17, 70), (44, 18, 54), 11, 10), 18)
    d = solids.cut(d, solids.ellipsoid(p, (32, 2, 96.5), (20, 13, 17)), 16)
    d = solids.join(d, solids.ellipsoid(p, (31.5, -1, 52.5), (19.6, 18.6, 19.3)), 9)
    d = solids.join(d, solids.ellipsoid(p, (0, -70, 52), (32, 24, 34)), 22)
    d = solids.join(d, solids.capsule(p, (0, 12, 72), (0, -36, 91), 6, 7), 15)
    d = solids.join(d, solids.ellipsoid(p, (0, -39, 92.5), (9.5, 9, 10.5)), 9)
    d = solids.join(d, solids.ellipsoid(p, (10.5, -43, 85), (6.5, 6, 9)), 6)
    d = solids.cut(d, solids.ellipsoid(p, (5.2, -50.5, 93), (2.8, 3.2, 4.2)), 3)
    return solids.join(d, solids.capsule(p, (0, -70, -22), (0, -260, -30), 37, 42), 30)


def hair(points):
    """Return the signed distance [mm] to the hair, a bob with a parting."""
    p = np.array(points, dtype=float)
    p[..., 0] = np.abs(p[..., 0])
    d = solids.ellipsoid(p, (0, 38, -14), (83, 88, 99))
    d = solids.join(d, solids.ellipsoid(p, (66, -28, -20), (23, 74, 50)), 30)
    d = solids.join(d, solids.ellipsoid(p, (0, -20, -70), (70, 78, 42)), 30)
    return solids.join(d, solids.ellipsoid(p, (0, 70, 30), (62, 50, 62)), 30)


def hair_window(points):
    """Return how far points of the hair lie outside the opening for the face, about [mm]."""
    slanted = points[..., 1] - 0.16 * points[..., 0]
    window = (np.hypot(points[..., 0] / 60, (slanted + 32) / 94) - 1) * 60
    behind = fields.smoothstep(5, -35, points[..., 2])
    return window + behind * 80
