"""What the temporal bias does to the vignette: jitter, blinks, and layers without weight."""

import numpy as np
import scipy.signal

from bench import layer_bodies, layer_vignette
from data_example.generator import play_cues

LAMBDAS = (0.0, 0.05, 0.2)
CUTOFF_HZ = 10.0
# half the time in which a blink's peak is looked for [s]
AROUND_S = 0.1
KEPT, DEAD = 0.95, 1e-3


def table(take: layer_vignette.Take) -> list[str]:
    """Return lines: a row for each strength, with the lip bias and without, and rule of balance.

    Jitter [mm] is the root mean square above 10 Hz over moving vertices of the clay head and the
    tortoise; error [mm] that against the planted layers. Blinks are peaks of the lids' closing on
    the clay head, against those of the planted layers: their mean, the least, and the share of at
    least 0.95.
    """
    bodies = [layer_bodies.body(take, name) for name in ("clay_layers", "tortoise")]
    heads = ["jit. clay", "jit. tort.", "err. clay", "err. tort.", "blinks", "least", "kept"]
    lines = [layer_vignette.row("", [*heads, *(f"no {n}" for n in take.made.layers)], 11)]
    true = [layer_bodies.displaced(body, take.planted) for body in bodies]
    cells = [jitter(moved, body, take.rate) for moved, body in zip(true, bodies, strict=True)]
    lines.append(layer_vignette.row("planted", cells, 11))
    for balance in ("mask_variance", "variance"):
        for sigma in (0.02, 0.0):
            for strength in LAMBDAS:
                how = layer_vignette.How(sigma, strength, balance=balance)
                solved = take.solve(how)
                moved = [layer_bodies.displaced(body, solved.u) for body in bodies]
                cells = [jitter(m, body, take.rate) for m, body in zip(moved, bodies, strict=True)]
                cells += [
                    layer_bodies.distance(body, m, t)[:, 0].mean()
                    for body, m, t in zip(bodies, moved, true, strict=True)
                ]
                kept = blinks(take, bodies[0], solved.u)
                cells += [kept.mean(), kept.min(), (kept >= KEPT).mean()]
                cells += list((solved.weights.max(axis=1) < DEAD).mean(axis=0))
                label = f"{balance}, bias {'on' if sigma else 'off'}, {strength:g}"
                lines.append(layer_vignette.row(label, cells, 11))
    return lines


def jitter(moved: np.ndarray, body: layer_bodies.Body, rate: float) -> float:
    """Return the root mean square above 10 Hz of moving vertices' motion (T, V, 3)."""
    sections = scipy.signal.butter(4, CUTOFF_HZ, "highpass", fs=rate, output="sos")
    fast = scipy.signal.sosfiltfilt(sections, moved[:, body.moving], axis=0)
    return float(np.sqrt(np.mean(np.sum(fast**2, axis=2))))


def blinks(take: layer_vignette.Take, body: layer_bodies.Body, u: np.ndarray) -> np.ndarray:
    """Return what is left (N,) of the peak of each blink's closing."""
    found, true = (closing(take, body, each) for each in (u, take.planted))
    time_s = np.arange(len(u)) / take.rate
    near = [np.abs(time_s - at) < AROUND_S for at in play_cues.VIGNETTE_BLINKS]
    return np.array([found[own].max() / true[own].max() for own in near])


def closing(take: layer_vignette.Take, body: layer_bodies.Body, u: np.ndarray) -> np.ndarray:
    """Return how far lids close (T,): the component of displacements along the closed lids'."""
    shut = layer_vignette.lone(take, ("blink", "closed"))
    own = body.masks[take.made.masks.index("eyes")] > 0.5
    lids = layer_bodies.displaced(body, shut, own).ravel()
    return layer_bodies.displaced(body, u, own).reshape(len(u), -1) @ lids / (lids @ lids)
