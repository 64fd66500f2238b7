"""How far emotion moves the curves of speech, and speech those of emotion.

The same thing is played twice under different conditions: composed on the actress' measured basis
with weights that the solver can find, without noise (`no noise`) and with it (`basis`), or with the
weights planted (`sums above one`), and by her face (`face`), whose markers and film points are no
sum of extremes. Curves are what is delivered: u of a layer's columns, and what the layer makes of
the clay head under each mask.
"""

import contextlib
from unittest import mock

import numpy as np

from bench import layer_bodies, layer_vignette
from data_example.generator import (
    capture,
    contours,
    landmarks,
    markers,
    params,
    play,
    play_cues,
    play_truth,
    skin,
)
from stages.files import layer_points

How = layer_vignette.How
RATE = 30
MARKER_NOISE_MM, FILM_NOISE_PX = 0.15, 0.3
# a curve that moves less than this has nothing to say
LEAST = 0.1
SHOWN = {"speech": "mouth", "emotion": "upper"}
FIRST = "as planted"
# by layer, what should leave it as it is, and how that is played
COMPARED = {
    "speech": {"noise alone": "again", "other emotion": "other emotion", "no emotion": "calm"},
    "emotion": {"noise alone": "again", "other words": "other words", "no words": "silent"},
}
NO_EMOTION = "0.00 1.00 neutral=1\n11.00 1.00 neutral=1"
OTHER_SENTENCES = {"sadness": 0.78, "anger": 3.45, "neutral": 5.72, "happiness": 8.72}


def table(take: layer_vignette.Take) -> list[str]:
    """Return lines: a row for each condition and way of solving.

    Curves are those of the mouth for speech, of the upper face for emotion. Their changes are
    shares of each curve's range: the root mean square over time, of the mean curve and of the
    worst; the 95th in a hundred; then the root mean square of the change of what the layer makes of
    the clay head under each mask, as a share of its largest.
    """
    heads = ["rms", "worst", "95 %", *take.made.masks]
    lines = [layer_vignette.row("", heads, 9, first=56)]
    ways = {
        "": How(lip_sigma=0.0),
        "; as by default": layer_vignette.DEFAULT,
        "; variance": How(0.0, balance="variance"),
        "; markers": How(0.0, points="markers"),
        "; no lean": How(0.0, lean=0.0),
        "; neither lean nor held": How(0.0, 0.0, lean=0.0),
        "; beyond 0.7": How(0.0, beyond=0.7),
        "; beyond 0.7, no lean": How(0.0, beyond=0.7, lean=0.0),
    }
    body = layer_bodies.body(take, "clay_layers")
    shown = {
        "no noise": on_basis(take, True, 0.0),
        "basis": on_basis(take, True, 1.0),
        "sums above one": on_basis(take, False, 1.0),
        "face": by_face(take),
    }
    for title, plays in shown.items():
        for way, how in ways.items():
            found = {name: solved(take, offsets, how) for name, offsets in plays.items()}
            for layer, others in COMPARED.items():
                for label, name in others.items():
                    cells = changes(take, body, layer, found[FIRST], found[name])
                    text = f"{title}: {layer}, {label}{way}"
                    lines.append(layer_vignette.row(text, cells, 9, first=56))
    return lines


def solved(take: layer_vignette.Take, offsets: np.ndarray, how: How) -> np.ndarray:
    """Return u (T, R, K) of offsets that were played."""
    gap = layer_vignette.lip_gap_of(take, offsets)
    return layer_vignette.solve(take.made, offsets, gap, RATE, how).u


def changes(take, body, layer: str, one: np.ndarray, other: np.ndarray) -> list[float]:
    """Return how far a layer's curves and displacements changed, as `table` says."""
    own = take.made.layer == take.made.layers.index(layer)
    still = np.array([name in ("neutral", "rest", "open") for _, name in take.made.extremes])
    mask = take.made.masks.index(SHOWN[layer])
    first, second = (u[:, mask, own & ~still] for u in (one, other))
    extent = np.ptp(np.concatenate([first, second]), axis=0)
    told = extent > LEAST
    apart = np.abs(first - second)[:, told] / extent[told]
    mean = np.sqrt(np.mean(apart**2, axis=0))
    cells = [mean.mean(), mean.max(), np.percentile(apart, 95)]
    alone = [np.where(own, u, 0.0) for u in (one, other)]
    shown = [layer_bodies.displaced(body, u) for u in alone]
    for mask in body.masks:
        chosen = body.moving & (mask > 0.5)
        size = np.linalg.norm(shown[0][:, chosen].reshape(len(one), -1), axis=1)
        change = np.linalg.norm((shown[0] - shown[1])[:, chosen].reshape(len(one), -1), axis=1)
        cells.append(np.sqrt(np.mean(change**2)) / size.max())
    return cells


def on_basis(take: layer_vignette.Take, normalised: bool, noise: float) -> dict:
    """Return offsets composed of planted weights and coefficients on the measured basis.

    As planted, emotion and speech in a talking mouth are 1.65 in sum; no weights on a simplex are.
    """
    step = round(take.rate / RATE)
    names = list(take.truth["extreme_names"])
    order = [names.index("_".join(extreme)) for extreme in take.made.extremes]
    a = take.truth["coefficient"].astype(float)[::step, order]
    weights = take.truth["strength"].astype(float)[::step]
    if normalised:
        weights = weights / weights.sum(axis=2, keepdims=True)
    layer, half = take.made.layer, len(a) // 2
    rolled = {
        name: np.where(layer == take.made.layers.index(name), np.roll(a, half, axis=0), a)
        for name in ("emotion", "speech")
    }
    calm = a.copy()
    calm[:, layer == take.made.layers.index("emotion")] = 0.0
    calm[:, take.made.extremes.index(("emotion", "neutral"))] = 1.0
    silent = a.copy()
    silent[:, layer == take.made.layers.index("speech")] = 0.0
    silent[:, take.made.extremes.index(("speech", "rest"))] = 1.0
    tracks = {FIRST: a, "again": a, "calm": calm, "silent": silent}
    tracks |= {"other emotion": rolled["emotion"], "other words": rolled["speech"]}
    return {
        name: _composed(take, weights, track) + noise * _noise(take, len(a), number)
        for number, (name, track) in enumerate(tracks.items())
    }


def _composed(take, weights: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """Return offsets (T, D) of layers on the measured basis."""
    made = take.made
    u = weights[:, :, made.layer] * coefficients[:, None]
    return sum(
        mask * (part @ made.basis.T)
        for mask, part in zip(made.mask_weights, np.moveaxis(u, 1, 0), strict=True)
    )


def _noise(take, count: int, seed: int) -> np.ndarray:
    """Return noise of markers and film points (T, D) [face units]."""
    group = layer_points.group_of(take.made.layout)
    kinds = np.array([each.kind for each in take.made.layout])[group]
    units = _units(take)
    size = np.where(
        kinds == "markers", MARKER_NOISE_MM / units["markers"], FILM_NOISE_PX / units["video"]
    )
    return size * np.random.default_rng(seed).standard_normal((count, len(group)))


def _units(take) -> dict[str, float]:
    """Return the face unit of markers [mm] and of film points [px]."""
    names = list(take.truth["marker_names"])
    ends = take.truth["marker_neutral"][[names.index(name) for name in ("RECO", "LECO")]]
    points = list(take.truth["point_names"])
    # the neutral without head motion, seen by the camera
    shown = _film(np.zeros((1, len(params.NAMES))))[0]
    middles = [
        shown[[i for i, name in enumerate(points) if name.startswith(f"eye_{side}")]].mean(axis=0)
        for side in ("right", "left")
    ]
    return {
        "markers": float(np.linalg.norm(ends[1] - ends[0])),
        "video": float(np.linalg.norm(middles[1] - middles[0])),
    }


def _film(table: np.ndarray) -> np.ndarray:
    """Return the film points (T, P, 2) [px] of a head that stays still."""
    shown = capture.Played(
        table, np.tile([0.0, 0.0, 0.0, 1.0], (len(table), 1)), np.zeros((len(table), 3))
    )
    drawn = play_truth.drawn(shown, range(len(table)), landmarks.brows())
    return np.stack([contours.point_set(lines) for _, lines in drawn])


def by_face(take: layer_vignette.Take) -> dict:
    """Return offsets of her face, which plays with and without emotion, and words."""
    emotions = play_cues.VIGNETTE_EMOTIONS
    notes = {
        FIRST: {},
        "again": {},
        "other emotion": {"VIGNETTE_EMOTIONS": _later(emotions)},
        "calm": {"VIGNETTE_EMOTIONS": NO_EMOTION},
        "other words": {"SENTENCES": OTHER_SENTENCES},
        "silent": {"VIGNETTE_SPEECH": "0:0 11:0"},
    }
    made = {}
    for number, (name, changed) in enumerate(notes.items()):
        with contextlib.ExitStack() as stack:
            for attribute, value in changed.items():
                stack.enter_context(mock.patch.object(play_cues, attribute, value))
            times = np.arange(round(play.VIGNETTE_S * RATE)) / RATE
            table = play.expression("vignette", times)
        made[name] = _seen(take, table) + _noise(take, len(table), number)
    return made


def _later(notes: str) -> str:
    """Return the director's notes with what is played moved on by half of them, strengths kept."""
    rows = [line.split() for line in notes.strip().splitlines()]
    half = len(rows) // 2
    shares = [row[2:] for row in rows[half:] + rows[:half]]
    return "\n".join(" ".join([*row[:2], *own]) for row, own in zip(rows, shares, strict=True))


def _seen(take, table: np.ndarray) -> np.ndarray:
    """Return the offsets (T, D) [face units] of an expression, less those of the neutral."""
    body = skin.build()
    glued = markers.glue(body)
    whole = np.concatenate([np.zeros((1, table.shape[1])), table])
    points = {
        "markers": capture.true_markers(body, glued, whole)[0],
        "video": _film(whole) * [1.0, -1.0],
    }
    known = {
        "markers": list(take.truth["marker_names"]),
        "video": list(take.truth["point_names"]),
    }
    units, columns = _units(take), []
    for group in take.made.layout:
        order = [known[group.kind].index(name) for name in group.names]
        values = points[group.kind][:, order] / units[group.kind]
        columns.append((values[1:] - values[0]).reshape(len(table), -1))
    return np.concatenate(columns, axis=1)
