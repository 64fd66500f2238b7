"""What the figures need of a shot: a region's points on the frames that were tracked well."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from bench.figures import example
from stages.core import key_shape_candidates, key_shape_selection, pca, region_features
from stages.files import basis, region_settings, regions

GOOD = 0.5


class RegionFrames(NamedTuple):
    """Hold a region's points over a shot.

    Attributes
    ----------
    points : (T, P, 2) float array [face units]
    neutral : (P, 2) float array [face units]
    weights : (P,) float array
    names : list of str
    frame : (T,) int array
        Number in the shot; frames that were not tracked well are left out.
    """

    points: np.ndarray
    neutral: np.ndarray
    weights: np.ndarray
    names: list[str]
    frame: np.ndarray


def read(show: Path, shot: str, region: str) -> RegionFrames:
    """Read a region of a shot of the example show."""
    performance = basis.read([example.of_shot(show, shot, "expression.parquet")], [shot])
    table_path = show / "config" / "regions.tsv"
    table = regions.read(table_path)
    chosen, weights = regions.select(table_path, table, region, performance.names)
    good = basis.region_confidence(performance, chosen) >= GOOD
    return RegionFrames(
        performance.points[good][:, chosen],
        performance.neutral[chosen],
        weights,
        [performance.names[index] for index in chosen],
        performance.frame[good],
    )


def features(region):
    """Return frames (T, 2P) and neutral (2P,) whose distances are root mean squares of points."""
    frames = region_features.stack(region.points, region.weights)
    return frames, region_features.stack(region.neutral, region.weights)


def candidates(frames, neutral, sigma):
    """Return frames (T, D) as candidates, all of them eligible, with their own axes."""
    eligible = np.ones(len(frames), bool)
    return key_shape_candidates.Candidates(frames, neutral, pca.fit(frames), eligible, sigma=sigma)


def choose(frames, neutral, count, method, sigma):
    """Return the rows of frames (T, D) that a selector takes as key shapes."""
    seen = candidates(frames, neutral, sigma)
    return [choice.frame for choice in key_shape_selection.choose(seen, count, method)]


def settings(show: Path, region: str) -> region_settings.Settings:
    """Return the show's settings of a region."""
    table = regions.read(show / "config" / "regions.tsv")
    return region_settings.read(show / "config" / "region_settings.tsv", table)[region]
