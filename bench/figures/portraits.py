"""Pictures of the actor and of the characters, side by side."""

from pathlib import Path

import numpy as np

from bench.figures import example, look, region_frames
from stages.core import head_transform, polygons, portrait, region_features
from stages.files import basis, film, regions, rig

SIDE = 480  # px
COLUMNS = 6
CHARACTERS = ("human", "radio", "drawing")


def character_pictures(
    character: rig.Rig, positions: np.ndarray, framed: np.ndarray | None = None
) -> list[np.ndarray]:
    """Draw positions of a character from one camera that sees them all, or others.

    Parameters
    ----------
    character : rig.Rig
    positions : (N, V, 3) float array [character's unit]
    framed : (M, V, 3) float array [character's unit], optional
        What the camera sees the whole of, in place of the positions.

    Returns
    -------
    list of (SIDE, SIDE, 3) uint8 arrays
    """
    seen = positions if framed is None else framed
    paint = portrait.painter(
        character.neutral,
        polygons.triangulate(character.sizes, character.corners),
        character.colours,
        head_transform.face_axes(character.up_axis),
        (seen.min(axis=(0, 1)), seen.max(axis=(0, 1))),
        SIDE,
    )
    return [paint(shape) for shape in positions]


def film_pictures(show: Path, shot: str, frames: list[int]) -> list[np.ndarray]:
    """Return pictures of the example's films, whose rate is constant."""
    named_in = example.of_shot(show, shot, "expression.parquet")
    found = film.frames_at(example.film(show, shot), frames, named_in)
    return [found[frame] for frame in frames]


def varied_frames(show: Path, shot: str) -> list[int]:
    """Return numbers of well tracked frames that differ much, in the order of time.

    Parameters
    ----------
    show : Path
    shot : str

    Returns
    -------
    list of int
    """
    performance = basis.read([example.of_shot(show, shot, "expression.parquet")], [shot])
    table_path = show / "config" / "regions.tsv"
    table = regions.read(table_path)
    parts, good = [], np.ones(len(performance.frame), bool)
    for region in table:
        chosen, weights = regions.select(table_path, table, region, performance.names)
        good &= basis.region_confidence(performance, chosen) >= region_frames.GOOD
        points = performance.points[:, chosen] - performance.neutral[chosen]
        parts.append(region_features.stack(points, weights))
    rows = np.flatnonzero(good)
    # every region's farthest frame counts as much: blinks are rare but large
    scaled = [part / np.linalg.norm(part[rows], axis=1).max() for part in parts]
    frame = performance.frame[rows]
    picked = farthest(np.concatenate(scaled, axis=1)[rows], frame, COLUMNS)
    return sorted(int(frame[row]) for row in picked)


def farthest(features, frame, count):
    """Pick rows one after another, each the farthest from zero and from all picked before.

    Frames nearer in time than a third of an even spacing are not picked together.

    Parameters
    ----------
    features : (T, D) float array
    frame : (T,) int array, ascending
    count : int

    Returns
    -------
    list of int
    """
    apart = (frame[-1] - frame[0]) / (3 * count)
    distance = np.linalg.norm(features, axis=1)
    picked = []
    for _ in range(count):
        row = int(distance.argmax())
        picked.append(row)
        distance = np.minimum(distance, np.linalg.norm(features - features[row], axis=1))
        distance[np.abs(frame - frame[row]) < apart] = -1.0
    return picked


def sheet(drawn, rows, names, titles, height):
    """Place rows of pictures, with their names at the left and frame numbers above.

    Parameters
    ----------
    drawn : figure.SubFigure
    rows : list of lists of (H, W, 3) uint8 arrays
    names : list of str
        One of each row.
    titles : list
        What stands above each column, a frame's number to begin with.
    height : float
        Share of the height, from the top, that the rows take.
    """
    left, top, gap = 0.022, 0.025 * height, 0.003
    wide = (1 - left - gap) / len(titles)
    tall = (height - top) / len(rows)
    for number, (pictures, name) in enumerate(zip(rows, names, strict=True)):
        bottom = 1 - top - (number + 1) * tall
        words = dict(look.TITLE, size=10, rotation=90, ha="center", va="center")
        drawn.text(left / 2 + 0.001, bottom + tall / 2, name, **words)
        for column, picture in enumerate(pictures):
            place = (left + column * wide, bottom, wide - gap, tall * (1 - gap))
            panel = drawn.add_axes(place)
            panel.imshow(picture, interpolation="antialiased")
            panel.set_axis_off()
    for column, title in enumerate(titles):
        middle = left + (column + 0.5) * wide - gap / 2
        words = {"ha": "center", "va": "center", "size": 9, "color": look.INK}
        drawn.text(middle, 1 - top / 2, f"frame {title}", **words)
