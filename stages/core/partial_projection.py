"""Coordinates on principal axes of frames on which some values were not observed."""

import numpy as np

from stages.core import pca

CHUNK = 512


def truncate(model, count):
    """Keep the first axes of a model, and say how much each coordinate varies off them.

    Parameters
    ----------
    model : pca.Pca
    count : int

    Returns
    -------
    pca.Pca
        With at most `count` axes.
    float
        Variance of a coordinate off the axes [feature unit squared], never quite zero.
    """
    kept = pca.Pca(model.mean, model.components[:count], model.variance[:count])
    left = max(len(model.mean) - len(kept.variance), 1)
    floor = 1e-8 * model.variance.max(initial=0.0)
    return kept, float(max(model.variance[count:].sum() / left, floor))


def project(model, noise, frames):
    """Project frames on the axes; values that are missing are first filled with the likeliest.

    A frame's observed values `o` give ``c = argmin |x_o - m_o - E_o' c|^2 / noise + c' L^-1 c``
    with the variances `L` of the axes `E`; then ``m + E' c`` stands for what is missing, and the
    frame is projected as any other: a frame that is whole is only projected.

    Parameters
    ----------
    model : pca.Pca
    noise : float
        Variance of a coordinate off the axes [feature unit squared], positive.
    frames : (T, D) float array [feature unit]
        NaN where not observed.

    Returns
    -------
    (T, C) float array
        The mean's coordinates, zero, for a frame without any value.

    Raises
    ------
    ValueError
        When the frames have other coordinates than the model.
    """
    frames = np.asarray(frames, float)
    if frames.ndim != 2 or frames.shape[1] != len(model.mean):
        raise ValueError(f"frames {frames.shape} for axes of {len(model.mean)} coordinates")
    missing = ~np.isfinite(frames)
    offsets = np.where(missing, 0.0, frames - model.mean)
    coordinates = offsets @ model.components.T
    partial = np.flatnonzero(missing.any(axis=1))
    for start in range(0, len(partial), CHUNK):
        rows = partial[start : start + CHUNK]
        gap = _unobserved(model.components, missing[rows])
        system = np.eye(len(model.variance)) - gap + np.diag(noise / model.variance)
        likeliest = np.linalg.solve(system, coordinates[rows][..., None])
        coordinates[rows] += (gap @ likeliest)[..., 0]
    return coordinates


def _unobserved(components, missing):
    """Return ``E_m E_m'`` (T, C, C) over the missing coordinates `m` of each frame."""
    count = len(components)
    products = (components[:, None] * components[None]).reshape(count * count, -1)
    return (missing.astype(float) @ products.T).reshape(-1, count, count)
