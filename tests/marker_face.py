"""A face of markers that moves: smooth shapes, a turning head, noise."""

import numpy as np


def smooth(rng, count, columns, frames):
    """Return noise (T, C) of deviation 1 that changes over a number of frames."""
    kernel = np.hanning(2 * frames + 1)
    noise = rng.standard_normal((count + 2 * frames, columns))
    passed = [np.convolve(noise[:, column], kernel, "valid") for column in range(columns)]
    return np.stack(passed, axis=1) / np.linalg.norm(kernel)


def rotations(angles):
    """Return rotations (T, 3, 3) about x, y and z in turn."""
    turned = np.broadcast_to(np.eye(3), (len(angles), 3, 3))
    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        step = np.zeros((len(angles), 3, 3))
        step[:, axis, axis] = 1
        step[:, i, i] = step[:, j, j] = np.cos(angles[:, axis])
        step[:, j, i] = np.sin(angles[:, axis])
        step[:, i, j] = -step[:, j, i]
        turned = step @ turned
    return turned


def take(seed=0, count=1200, noise=0.15, shapes=5):
    """Return the true markers (T, 24, 3) [mm] in space, and the same with noise."""
    rng = np.random.default_rng(seed)
    columns, rows = np.meshgrid(np.linspace(-60, 60, 6), np.linspace(-50, 50, 4))
    neutral = np.stack([columns, rows, 40 - (columns**2 + rows**2) / 120], axis=-1).reshape(-1, 3)
    centres = rng.uniform(-50, 50, (shapes, 2))
    apart = np.linalg.norm(neutral[:, None, :2] - centres, axis=2)
    size = np.exp(-((apart / 45) ** 2)) * (neutral[:, 1] < 45)[:, None]
    deltas = size.T[:, :, None] * rng.normal(0, 4, (shapes, 1, 3))
    face = neutral + np.einsum("tk,kpd->tpd", smooth(rng, count, shapes, 15), deltas)
    turned = rotations(0.15 * smooth(rng, count, 3, 60))
    moved = np.einsum("tij,tpj->tpi", turned, face) + 20 * smooth(rng, count, 3, 80)[:, None]
    return moved, moved + noise * rng.standard_normal(moved.shape)
