"""Figure 6 of Deng et al.: frames of a marker take beside the same rig, moved by each method."""

from pathlib import Path

import numpy as np

from bench.figures import example, look, own_figure, portraits, rig_methods
from data_example.generator import marker_cues
from stages.core import marker_panel
from stages.files import film, series

WIDTH, TOP = 12.0, 0.25  # inches
COUNTS = {"neutral": 1, "happiness": 2, "anger": 2, "sadness": 1}  # of the six frames
APART = 4  # frames at least from every tuned one
METHODS = {
    rig_methods.EQUATION: "equation, published",
    rig_methods.CLIP: "equation, whole clip",
    rig_methods.PUBLISHED: "RBF, published",
    rig_methods.LINEAR: "RBF and linear",
    "true": "truth",
}


def draw(show: Path, path: Path) -> None:
    """Draw film, markers and the clay head as each method moves it, and state the errors."""
    played = rig_methods.play(show)
    rate = film.nominal_rate(example.capture_film(show))
    step = played.driving.rate / rate
    frames, moods = chosen_frames(played, int(step))
    pictures = _film(show, [int(frame / step) for frame in frames])
    rows = [pictures, _markers(show, frames), *_heads(show, played, frames)]
    height = len(rows) * WIDTH / len(frames) + TOP
    whole, drawn = look.page(WIDTH, height, _caption(played))
    names = ["film", "markers", *METHODS.values()]
    titles = [f"{frame}, {mood}" for frame, mood in zip(frames, moods, strict=True)]
    portraits.sheet(drawn, rows, names, titles, 1.0)
    look.save(whole, path)


def chosen_frames(played: rig_methods.Played, step: int) -> tuple[list[int], list[str]]:
    """Return frames that differ much, none of them near a tuned one, and the emotion of each.

    Parameters
    ----------
    played : rig_methods.Played
    step : int
        Frames of the markers for each picture of the film.
    """
    driving = played.driving
    features = np.nan_to_num(driving.points - driving.neutral).reshape(len(driving.frame), -1)
    distance = np.abs(driving.frame[:, None] - played.tuned).min(axis=1)
    free = (distance >= APART) & (driving.frame % step == 0)
    starts = [*marker_cues.SENTENCES.values(), driving.time_s[-1]]
    frames, moods = [], []
    for mood, start, end in zip(marker_cues.SENTENCES, starts, starts[1:], strict=False):
        rows = np.flatnonzero(free & (driving.time_s >= start) & (driving.time_s < end))
        picked = portraits.farthest(features[rows], driving.frame[rows], COUNTS[mood])
        frames += sorted(int(driving.frame[rows[row]]) for row in picked)
        moods += [mood] * COUNTS[mood]
    return frames, moods


def _film(show, numbers):
    """Return pictures of the marker take's film."""
    named_in = example.of_shot(show, rig_methods.SHOT, "expression.parquet")
    found = film.frames_at(example.capture_film(show), numbers, named_in)
    return [found[number] for number in numbers]


def _markers(show, frames):
    """Return square pictures of the markers with the motion of the head."""
    path = example.of_shot(show, rig_methods.SHOT, "performance.parquet")
    performance = series.read(path, "performance")
    names = series.point_names(performance, "xyz")
    points = series.stack(performance, path, names, "xyz")
    repaired = np.stack([performance.columns[f"{name}.repaired"] for name in names], axis=1)
    paint = marker_panel.painter(points, repaired)
    side = (marker_panel.HEIGHT - marker_panel.WIDTH) // 2
    pictures = []
    for frame in frames:
        picture = np.empty((marker_panel.HEIGHT, marker_panel.HEIGHT, 3), np.uint8)
        picture[:] = marker_panel.GROUND
        picture[:, side:-side] = paint(frame)
        pictures.append(picture)
    return pictures


def _heads(show, played, frames):
    """Return a row of pictures for each method, all from one camera."""
    moved = []
    for method in METHODS:
        offsets = np.tensordot(played.weights[method][frames], played.deltas, axes=1)
        shapes = played.character.neutral + offsets
        moved.append(own_figure.with_head(show, rig_methods.SHOT, played.character, shapes, frames))
    # the truth comes last
    pictures = portraits.character_pictures(played.character, np.concatenate(moved), moved[-1])
    count = len(frames)
    return [pictures[start : start + count] for start in range(0, len(pictures), count)]


def _caption(played):
    """Return the caption with the mean error of every method."""
    count = len(played.weights["true"])
    distance = np.abs(np.arange(count)[:, None] - played.tuned).min(axis=1)
    errors = {
        name: rig_methods.errors_mm(played, method)[distance >= APART].mean()
        for method, name in METHODS.items()
        if method != "true"
    }
    found = "; ".join(f"{name} {error:.2f}" for name, error in errors.items())
    return (
        "Figure 6 of Deng et al. Frames of the marker take 'capture', counted at 120 Hz, none of "
        f"them among its {len(played.tuned)} tuned pairs, and the clay head that they drive: by "
        "the blendshape equation as published (least squares on positions; its weights, of any "
        "size, are cut off at the rig's limits) and over the whole clip within these limits; by "
        f"radial basis functions as published ({rig_methods.DIMENSIONS} dimensions) and beside a "
        "linear part with dimensions and widths cross-validated; and as the generator knows it. "
        "Before smoothing, with the head's motion. Mean distance of vertices from the truth, over "
        f"all frames at least {APART} from a tuned one, in mm: {found}."
    )
