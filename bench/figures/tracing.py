"""Contours as a hand traces them: close to what was tracked, and not the same."""

import numpy as np

WAVES = 4


def error(count, contours, size, seed):
    """Draw the error of a traced set of shapes: smooth along every contour.

    Each closed contour of each shape is displaced by a constant and `WAVES` waves round it, of
    random strength and phase, a wave of m periods m times weaker than the first.

    Parameters
    ----------
    count : int
        Shapes.
    contours : (P,) array
        Name of each point's closed contour; a contour's points are in order.
    size : float [face units]
        Root mean square displacement of a point.
    seed : int

    Returns
    -------
    (count, P, 2) float array [face units]

    Notes
    -----
    CB02 section 4.1 and figure 3: lip shapes traced by hand.
    """
    contours = np.asarray(contours)
    generator = np.random.default_rng(seed)
    moved = np.zeros((count, len(contours), 2))
    for name in dict.fromkeys(contours):
        rows = np.flatnonzero(contours == name)
        waves = _waves(len(rows))
        moved[:, rows] = np.einsum(
            "skd,kp->spd", generator.normal(size=(count, len(waves), 2)), waves
        )
    return size / np.sqrt(2) * moved


def _waves(points):
    """Return waves (2 WAVES + 1, points) whose squares sum to one on average."""
    angle = 2 * np.pi * np.arange(points) / points
    rows = [np.ones(points)]
    for periods in range(1, WAVES + 1):
        rows += [np.sqrt(2) / periods * wave(periods * angle) for wave in (np.cos, np.sin)]
    waves = np.array(rows)
    return waves / np.sqrt((waves**2).mean(axis=1).sum())
