"""Compare the example show's results with the truth that its generator kept beside the films."""

import sys
from pathlib import Path

import numpy as np

from stages.files import series

SHOTS = ("rom", "talk", "turn")
MOUTH = ("lips_outer", "lips_inner")
OPENING = ("lips_inner_04", "lips_inner_12")
GOOD = 0.5


def table(show: Path) -> list[str]:
    """Return the lines of a table, one a shot: points, opening, head rotation, lost frames."""
    lines = [
        "shot   points  mouth   worst  opening         roll    frames  false",
        "       [% io]  [% io]  [% io] corr.  slope    [deg]   lost    good",
    ]
    for shot in SHOTS:
        truth = dict(np.load(show / "data_example" / "truth" / f"{shot}.npz"))
        lines.append(_line(show, shot, truth))
    return lines


def _line(show: Path, shot: str, truth: dict) -> str:
    """Return the figures of one shot."""
    names = list(truth["point_names"])
    path = show / "results" / "shots" / shot / "tracked.parquet"
    tracked = series.read(path, "tracked")
    points = series.stack(tracked, path, names)
    between = _centre(truth, names, "eye_left") - _centre(truth, names, "eye_right")
    unit = np.linalg.norm(between, axis=1)
    error = 100 * np.linalg.norm(points - truth["landmarks"], axis=2) / np.median(unit)
    mouth = [index for index, name in enumerate(names) if name.startswith(MOUTH)]
    upper, lower = (names.index(name) for name in OPENING)
    opening = np.linalg.norm(points[:, upper] - points[:, lower], axis=1)
    known = np.isfinite(opening)
    slope = np.polyfit(truth["opening_px"][known], opening[known], 1)[0]
    correlation = np.corrcoef(truth["opening_px"][known], opening[known])[0, 1]
    confidence = tracked.columns["confidence"]
    mean = np.nanmean(error, axis=1)
    roll = _roll_error(show, shot, truth)
    false_good = int(((confidence > GOOD) & (mean > 10)).sum())
    return (
        f"{shot:6} {np.nanmean(error):6.2f}  {np.nanmean(error[:, mouth]):6.2f}"
        f"  {np.nanmax(mean):6.2f}  {correlation:.4f} {slope:6.3f}  {roll:6.3f}"
        f"  {int((~known).sum()):6d}  {false_good:5d}"
    )


def _centre(truth: dict, names: list[str], contour: str) -> np.ndarray:
    """Return the (T, 2) centre of a contour."""
    rows = [index for index, name in enumerate(names) if name.startswith(contour)]
    return truth["landmarks"][:, rows].mean(axis=1)


def _roll_error(show: Path, shot: str, truth: dict) -> float:
    """Return the mean error of the head's rotation in the picture plane [deg]."""
    motion = series.read(show / "results" / "shots" / shot / "head_motion.parquet", "head_motion")
    found = 2 * np.arctan2(motion.columns["rotation.z"], motion.columns["rotation.w"])
    true = _true_roll(truth)
    difference = np.degrees(found - true)
    return float(np.nanmean(np.abs(difference - np.nanmedian(difference))))


def _true_roll(truth: dict) -> np.ndarray:
    """Return the rotation in the plane [rad] of the polar part of the projected head frame."""
    x, y, z, w = truth["quaternion"].T
    # the upper left 2 x 2 block of the rotation matrix, y up as in the face's own axes
    a, b = 1 - 2 * (y * y + z * z), 2 * (x * y - z * w)
    c, d = 2 * (x * y + z * w), 1 - 2 * (x * x + z * z)
    return np.arctan2(c - b, a + d)


if __name__ == "__main__":
    sys.stdout.write("\n".join(table(Path(sys.argv[1] if len(sys.argv) > 1 else "."))) + "\n")
