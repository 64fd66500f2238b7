"""Lips from key shapes that were traced by hand: what each solve makes of them (CB02 4.1)."""

from typing import NamedTuple

import numpy as np

from bench.figures import region_frames, tracing
from stages.core import key_weights
from stages.files import point_set

COUNT = 21
METHOD = "maximum_spread"
TRACING = 0.015  # face units
DRAWS = 20
PLAIN, NONNEGATIVE, DEFAULT = "least squares", "non-negative", "default"


class How(NamedTuple):
    """Say how weights are solved, and whether shapes are taken minus the neutral."""

    solve: str
    offset: bool
    sigma: float = 0.0
    bound: float | None = None


def solves(settings):
    """Return the two published solves on absolute shapes, and the show's own, by name."""
    return {
        PLAIN: How("least_squares", False),
        NONNEGATIVE: How("nonnegative_absolute", False),
        DEFAULT: How(settings.solve, True, settings.sigma, settings.bound),
    }


class Reconstruction(NamedTuple):
    """Hold what a solve makes of a take.

    Attributes
    ----------
    source, target : (T, P, 2) float array [face units]
        With the tracked key shapes, and with those of the first tracing.
    source_error, target_error : (T,) float array [face units]
        Root mean square distance of a frame's points from the tracked ones.
    target_rms : float [face units]
        Over all frames and `DRAWS` tracings.
    largest : float
        Greatest magnitude of a weight.
    """

    source: np.ndarray
    target: np.ndarray
    source_error: np.ndarray
    target_error: np.ndarray
    target_rms: float
    largest: float


class Trial(NamedTuple):
    """Hold the trial's data and what every solve makes of it.

    Attributes
    ----------
    frames : (T, P, 2) float array [face units]
    shapes, traced : (K, P, 2) float array [face units]
    contours : (P,) array of the contours' names
    numbers : (T,) int array, of the frames in their shot
    solved : dict of Reconstruction by name, see `solves`
    """

    frames: np.ndarray
    shapes: np.ndarray
    traced: np.ndarray
    contours: np.ndarray
    numbers: np.ndarray
    solved: dict[str, Reconstruction]


def run(lips, basis, settings):
    """Choose key shapes from a basis, trace them, and rebuild a take from both sets.

    Parameters
    ----------
    lips, basis : region_frames.RegionFrames
        The take, and the frames that key shapes are chosen from; may be the same.
    settings : region_settings.Settings

    Returns
    -------
    Trial
    """
    flat = basis.points.reshape(len(basis.points), -1)
    chosen = region_frames.choose(flat, basis.neutral.ravel(), COUNT, METHOD, settings.sigma)
    shapes = basis.points[chosen]
    contours = np.array([point_set.contour_of(name) for name in lips.names])
    # the last row is the neutral, which is traced like the rest
    drawn = [tracing.error(COUNT + 1, contours, TRACING, seed) for seed in range(DRAWS)]
    solved = {
        name: reconstruct(lips.points, shapes, lips.neutral, drawn, how)
        for name, how in solves(settings).items()
    }
    return Trial(lips.points, shapes, shapes + drawn[0][:-1], contours, lips.frame, solved)


def reconstruct(frames, shapes, neutral, drawn, how):
    """Solve weights on tracked key shapes and play them on tracked and on traced ones.

    Parameters
    ----------
    frames : (T, P, 2) float array [face units]
    shapes : (K, P, 2) float array [face units]
    neutral : (P, 2) float array [face units]
    drawn : list of (K + 1, P, 2) float arrays [face units]
        Errors of tracings: of the K shapes, and of the neutral.
    how : How
        Without offsets, shapes are played as ``sum_i w_i s_i`` (eq. 3).

    Returns
    -------
    Reconstruction
    """
    origin = neutral if how.offset else np.zeros_like(neutral)
    flat = [array.reshape(len(array), -1) for array in (frames, shapes)]
    weights = key_weights.solve(*flat, origin.ravel(), how.solve, how.sigma, how.bound).weights
    source = play(weights, shapes, origin)
    targets = (
        play(weights, shapes + error[:-1], origin + how.offset * error[-1]) for error in drawn
    )
    first, *others = [(target, point_error(target, frames)) for target in targets]
    squares = [first[1] ** 2, *(error**2 for _, error in others)]
    return Reconstruction(
        source,
        first[0],
        point_error(source, frames),
        first[1],
        float(np.sqrt(np.mean(squares))),
        float(np.abs(weights).max()),
    )


def play(weights, shapes, origin):
    """Return ``origin + sum_i w_i (shape_i - origin)`` (T, P, 2) of weights (T, K)."""
    return origin + np.tensordot(weights, shapes - origin, axes=1)


def point_error(points, truth):
    """Return the root mean square distance (T,) of the points of every frame."""
    return np.sqrt(((points - truth) ** 2).sum(axis=2).mean(axis=1))


def rms(errors):
    """Return the root mean square of errors."""
    return float(np.sqrt(np.mean(np.square(errors))))


def sample(trial, name, count):
    """Return frames that stand for a solve: spread over time, and its worst in the target."""
    worst = int(trial.solved[name].target_error.argmax())
    spread = np.linspace(0, len(trial.frames) - 1, count + 2).astype(int)[1:-1]
    return [*spread.tolist(), worst]
