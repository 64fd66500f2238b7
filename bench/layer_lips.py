"""Lip closures of the vignette on every character, what the lip bias costs, and directing."""

import numpy as np

from bench import layer_bodies, layer_seams, layer_vignette
from stages.core import directing, layer_solver
from stages.files import series

How = layer_vignette.How
# of the height of a face, below which lips are closed
CLOSED = 0.005
# gamma above which lips count as closed, and how little an upper face then moves, of what it does
# without the bias, to be held still; emotion in the mouth that is there, and that is gone
SURE, STILL, THERE, GONE = 0.9, 0.1, 0.3, 0.05
# sounds that close the lips, and how far from them they may close [s]
SOUNDS, AROUND_S = ("p", "b", "m"), 0.03
SIGMAS = (0.0, 0.01, 0.02, 0.03, 0.05)
RATES = ("recall", "prec.", "rec. +-1", "prec. +-1")
HEADS = [*RATES, *(f"t. {rate}" for rate in RATES)]
# gaps, less that of closed lips, below which lips may be taken for closed [face units]
SEEN = {
    "film": (0.01, 0.02, 0.03),
    "markers": (0.001, 0.01, 0.03),
    "either": (0.005, 0.015),
    "told": (0.008, 0.012),
}
DIRECTED = {
    "joy": ("serenity", "joy", "ecstasy"),
    "surprise": ("surprise", "amazement"),
    "anger": ("anger", "rage"),
    "sadness": ("sadness", "grief"),
}


def closed(take: layer_vignette.Take) -> np.ndarray:
    """Return on which frames (T,) her lips are closed."""
    height = np.ptp(take.truth["marker_neutral"][:, 1])
    return take.truth["opening_mm"] < CLOSED * height


def near(flags: np.ndarray) -> np.ndarray:
    """Return flags (T,) that are set on their neighbours too."""
    return flags | np.append(flags[1:], False) | np.append(False, flags[:-1])


def rates(found: np.ndarray, true: np.ndarray, chosen: np.ndarray) -> list[float]:
    """Return recall and precision of closed frames, strict and with one frame of grace [1]."""
    result = []
    for grace in (lambda flags: flags, near):
        hit = (found & grace(true) & chosen).sum() / max((found & chosen).sum(), 1)
        recall = (true & grace(found) & chosen).sum() / max((true & chosen).sum(), 1)
        result += [recall, hit]
    return result


def closures(take: layer_vignette.Take) -> list[str]:
    """Return lines: recall and precision of every mouth under several biases."""
    true, talks = closed(take), layer_vignette.talking(take)
    every = np.ones(len(true), bool)
    cases = {"planted": take.planted}
    cases |= {f"sigma {sigma:g}": take.solve(How(lip_sigma=sigma)).u for sigma in SIGMAS}
    cases["sigma 0.02, published"] = take.solve(How(lip_bias="published")).u
    cases["sigma 0.012, told"] = take.solve(How(lip_sigma=0.012, lips="told")).u
    for lips in ("markers", "either", "truth"):
        cases[f"sigma 0.02, gap by {lips}"] = take.solve(How(lips=lips)).u
    cases["sigma 0.02, temporal 0"] = take.solve(How(temporal=0.0)).u
    lines = [f"{true.sum()} closed frames, {(true & talks).sum()} of them while she talks (t.)"]
    lines.append(layer_vignette.row("seen, by the lips' gap alone", HEADS, 12))
    for lips, limits in SEEN.items():
        for limit in limits:
            shut = np.nan_to_num(take.gaps[lips], nan=np.inf) < limit
            cells = rates(shut, true, every) + rates(shut, true, talks)
            lines.append(layer_vignette.row(f"  {lips}, below {limit:g}", cells, 12, 2))
    for name in layer_vignette.CHARACTERS:
        body = layer_bodies.body(take, name)
        gaps = {label: layer_seams.gaps(body, u) for label, u in cases.items()}
        for lips in ("film", "told", "truth"):
            how = How(lip_sigma=0.012, lip_bias="gap", lips=lips, character=name)
            gaps[f"sigma 0.012, {lips}, own gap"] = layer_seams.gaps(body, take.solve(how).u)
        gaps["as delivered"] = layer_seams.gaps(body, delivered(take, body))
        for mouth in gaps["planted"]:
            title = f"{name} {mouth}" if name == "globe" else name
            lines.append(layer_vignette.row(title, HEADS, 12))
            for label, found in gaps.items():
                shut = layer_seams.middle(found[mouth]) < CLOSED
                cells = rates(shut, true, every) + rates(shut, true, talks)
                lines.append(layer_vignette.row("  " + label, cells, 12, 2))
    return lines


def delivered(take: layer_vignette.Take, body: layer_bodies.Body) -> np.ndarray:
    """Return the weights (T, C) of a character's take as the show delivered them."""
    folder = take.show / "results/takes" / layer_vignette.SHOT / body.name
    found = series.read(folder / "weights.parquet", "weights")
    values = np.stack([found.columns[name] for name in body.names], axis=1)
    rows = np.round(np.arange(len(take.offsets)) / take.rate * float(found.rate)).astype(int)
    return values[np.minimum(rows, len(values) - 1)]


def costs(take: layer_vignette.Take) -> list[str]:
    """Return lines: what becomes of upper face and emotion while the lips count as closed."""
    heads = ["frames", "longest", "emotion w", "off", "wiped", "speed on", "off", "frozen"]
    lines = [layer_vignette.row("", [*heads, "error on", "off"], 10)]
    free = take.solve(How(lip_sigma=0.0))
    mouth, upper = take.made.masks.index("mouth"), take.made.masks.index("upper")
    emotion = take.made.layers.index("emotion")
    for name in ("clay_layers", "tortoise"):
        body = layer_bodies.body(take, name)
        own = body.moving & (body.masks[upper] > 0.5)
        true = layer_bodies.displaced(body, take.planted, own)
        apart = layer_bodies.displaced(body, free.u, own)
        for sigma in (0.012, 0.02):
            for bias in layer_solver.LIP_BIASES:
                how = How(lip_sigma=sigma, lip_bias=bias, lips="told", character=name)
                biased = take.solve(how)
                held = layer_bodies.displaced(body, biased.u, own)
                sure = biased.gamma > SURE
                weight, other = (each.weights[sure, mouth, emotion] for each in (biased, free))
                slow, fast = speed(held)[sure], speed(apart)[sure]
                cells = [sure.mean(), longest(sure) / take.rate, weight.mean(), other.mean()]
                cells += [((weight < GONE) & (other > THERE)).mean()]
                cells += [slow.mean(), fast.mean(), (slow < STILL * fast).mean()]
                cells += [np.linalg.norm(m - true, axis=2)[sure].mean() for m in (held, apart)]
                label = f"{name}, sigma {sigma:g}, {bias}"
                lines.append(layer_vignette.row(label, cells, 10, first=42))
    lines[0] = layer_vignette.row("", [*heads, "error on", "off"], 10, first=42)
    return lines


def speed(moved: np.ndarray) -> np.ndarray:
    """Return how far vertices (T, V, 3) move from the last frame, in the mean (T,)."""
    step = np.linalg.norm(np.diff(moved, axis=0), axis=2).mean(axis=1)
    return np.append(step[:1], step)


def longest(flags: np.ndarray) -> int:
    """Return the length of the longest run of set flags."""
    ends = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return int(np.max(ends[1::2] - ends[::2], initial=0))


def directed(take: layer_vignette.Take) -> list[str]:
    """Return lines: speech curves and closures once emotions are turned down."""
    solved, made = take.solve(layer_vignette.DEFAULT), take.made
    time_s = np.arange(len(take.offsets)) / take.rate
    emotion = [k for k, (layer, _) in enumerate(made.extremes) if layer == "emotion"]
    chosen = {"nothing": []}
    for family, names in DIRECTED.items():
        chosen[family] = [made.extremes.index(("emotion", name)) for name in names]
    chosen["all emotion"] = emotion
    spoken = made.layer == made.layers.index("speech")
    bodies = {name: layer_bodies.body(take, name) for name in layer_vignette.CHARACTERS}
    windows = bilabials(take)
    mouths = [(n, mouth) for n, body in bodies.items() for mouth in layer_seams.of(n)]
    heads = [mouth.removeprefix("mouth_") if n == "globe" else n[:8] for n, mouth in mouths]
    lines = [f"{len(windows)} sounds p, b, m; closed of them, and speech as it was"]
    lines.append(layer_vignette.row("turned to 0", [*heads, "same"], 10, first=16))
    parts = solved.weights, solved.coefficients, solved.amplitudes, made.layer
    for label, extremes in chosen.items():
        change = directing.Direction(np.array(extremes, int), 0.0, -np.inf, np.inf, 0.2)
        gains = directing.gains(time_s, len(made.extremes), [change])
        # the characters' own neutrals are those of their layers
        u = directing.composed(*parts, gains, np.full(len(made.layers), -1))
        same = np.array_equal(u[:, :, spoken], solved.u[:, :, spoken])
        cells = []
        for body in bodies.values():
            gaps = layer_seams.gaps(body, u)
            cells += [shut(layer_seams.middle(gap), windows) for gap in gaps.values()]
        lines.append(layer_vignette.row(label, [*cells, "yes" if same else "no"], 10, 0, first=16))
    return lines


def bilabials(take: layer_vignette.Take) -> list[np.ndarray]:
    """Return the frames of each sound that closes the lips."""
    time_s = np.arange(len(take.offsets)) / take.rate
    truth, found = take.truth, []
    for name, start, end in zip(
        truth["phones"], truth["phone_start_s"], truth["phone_end_s"], strict=True
    ):
        if name in SOUNDS:
            found.append(np.flatnonzero((time_s > start - AROUND_S) & (time_s < end + AROUND_S)))
    return found


def shut(gap: np.ndarray, windows: list[np.ndarray]) -> float:
    """Return on how many of some stretches of time a mouth closes."""
    return float(sum(gap[window].min() < CLOSED for window in windows))
