"""The face of the show of layers: what it shows in its takes, and where its markers are.

It is a plate of three masks. In the take `a` it shows each extreme of emotion, speech and blink by
itself; in `b` it mixes them by factors that are planted. Times are those of the film, which starts
`AHEAD_S` after `b`.
"""

import numpy as np

RATE = 30
AHEAD_S, LENGTH_S = 0.4, 1.6  # of the markers before the film, of the film
COLUMNS, ROWS = 7, 8
MASKS = ("upper", "mouth", "eyes")
LAYERS = ("emotion", "speech", "blink")
RESTS = {"emotion": "neutral", "speech": "rest", "blink": "open"}
EXTREMES = [
    ("emotion", "joy"),
    ("emotion", "surprise"),
    ("emotion", "rage"),
    ("speech", "m"),
    ("speech", "aa"),
    ("blink", "half"),
    ("blink", "closed"),
]
PEAKS = {extreme: 6 + 9 * i for i, extreme in enumerate(EXTREMES)}  # frames of `a`
MM = 15.0  # of the actor's face where the plate has 1


def grid():
    """Return column (V,) and row (V,) of the plate's vertices."""
    x, y = np.indices((COLUMNS, ROWS))
    return x.ravel(), y.ravel()


def neutral(scale=1.0, depth=0.2):
    """Return the vertices (V, 3) of a bent plate."""
    x, y = grid()
    return scale * np.stack([x - 3.0, y - 4.0, -depth * (x - 3) ** 2 - 0.05 * (y - 4) ** 2], axis=1)


def masks():
    """Return the masks (R, V): one row of vertices is half the mouth's, half the upper face's."""
    _, y = grid()
    mouth = np.select([y < 3, y == 3], [1.0, 0.5], 0.0)
    eyes = np.isin(y, (4, 5)).astype(float)
    return np.stack([1 - mouth - eyes, mouth, eyes])


def poses(seed, size):
    """Return the differences (K, V, 3) of the extremes; sides and top of the plate never move."""
    x, y = grid()
    loose = (x % (COLUMNS - 1) > 0) & (y < ROWS - 1)
    held = {"emotion": loose, "speech": loose & (y < 4), "blink": loose & np.isin(y, (4, 5))}
    rng = np.random.default_rng(seed)
    offsets = np.stack(
        [held[layer][:, None] * rng.uniform(-0.12, 0.12, (len(x), 3)) for layer, _ in EXTREMES]
    )
    # lips: the middle of the rows 1 and 2
    for extreme, lower, upper in ((("speech", "m"), 0.3, -0.3), (("speech", "aa"), -0.5, 0.1)):
        lips = offsets[EXTREMES.index(extreme)]
        lips[(y <= 1) & loose, 1] = lower
        lips[(y == 2) & loose, 1] = upper
    return size * offsets


def factors(time_s):
    """Return planted weights (T, R, J), coefficients (T, K) and amplitudes (T, J) of `b`."""

    def wave(rate, phase):
        return 0.5 - 0.5 * np.cos(2 * np.pi * (rate * np.maximum(time_s, 0) + phase))

    weights = np.empty((len(time_s), len(MASKS), len(LAYERS)))
    for mask, (speech, blink) in enumerate(((0.1, 0.1), (0.75, 0.05), (0.05, 0.7))):
        weights[:, mask, 1] = speech * (0.7 + 0.3 * wave(0.6, 0.2 * mask))
        weights[:, mask, 2] = blink * (0.7 + 0.3 * wave(0.8, 0.3 * mask))
    weights[..., 0] = 1 - weights[..., 1:].sum(axis=-1)
    coefficients = np.stack([wave(0.3 + 0.17 * k, 0.11 * k) for k in range(len(EXTREMES))], axis=1)
    coefficients[:, :3] /= 3.2  # what is left to one is the rest's of each layer
    coefficients[:, 3:] /= 2.1
    amplitudes = 0.6 + 0.35 * np.stack([wave(0.5, 0), wave(0.9, 0.3), wave(0.4, 0.7)], axis=1)
    return weights, coefficients, amplitudes


def mixture(time_s):
    """Return the planted weights (T, R, K) of extremes under masks in `b`."""
    weights, coefficients, amplitudes = factors(time_s)
    layer = [LAYERS.index(each) for each, _ in EXTREMES]
    return weights[:, :, layer] * (coefficients * amplitudes[:, layer])[:, None]


def composed(under, offsets):
    """Return the differences (T, V, 3) that weights (T, R, K) make of extremes (K, V, 3)."""
    return np.einsum("trk,rv,kvd->tvd", under, masks(), offsets)


def shown(shot):
    """Return the weights (T, R, K) of a take, from its markers' first frame."""
    if shot == "b":
        count = round((AHEAD_S + LENGTH_S) * RATE)
        return mixture(np.arange(count) / RATE - AHEAD_S)
    frame = np.arange(max(PEAKS.values()) + 9)
    away = np.stack([np.clip(abs(frame - peak) / 5, 0, 1) for peak in PEAKS.values()], axis=1)
    return np.repeat((0.5 + 0.5 * np.cos(np.pi * away))[:, None], len(MASKS), axis=1)


def marker_places(shot):
    """Return places (T, V, 3) [mm] of a take's markers, on every vertex, and the head's turns."""
    face = neutral() + composed(shown(shot), poses(1, 1.0))
    turn = 0.2 * np.sin(2 * np.pi * 0.6 * np.arange(len(face)) / RATE) * (shot == "b")
    cosine, sine, none = np.cos(turn), np.sin(turn), np.zeros(len(turn))
    about_y = np.array([[cosine, none, sine], [none, none + 1, none], [-sine, none, cosine]])
    places = MM * np.einsum("ijt,tpj->tpi", about_y, face)
    return places + np.stack([20 * turn, 1500 + 10 * turn, none], axis=1)[:, None]
