"""Try the tracker on a folder of films with labels and reference tracks: `--data FOLDER`.

The folder holds films, `labels.csv` (columns clip, frame, point, x_px, y_px) and
`reference/<clip>.csv` (columns frame, `<point>.x`, `<point>.y`; blank cells were not found).
Trained on all labels, scored on every clip that no label comes from. Errors are mean distances
from the reference in percent of the distance between the pupils, frame by frame; the mouth's
opening is the distance between the middles of the inner lips, in the same unit.
"""

import argparse
import csv
import sys
import time
from pathlib import Path

import numpy as np

from stages.core import face_tracker, point_groups, similarity, tracker_training
from stages.files import film, point_set

EYES = ("pupil_right", "pupil_left")
MOUTH = "lips_"
INNER = "lips_inner"
SEED = 1


def read_labels(path: Path) -> tuple[list[str], dict[str, dict[int, np.ndarray]]]:
    """Return the points' names and clip -> frame -> (P, 2) [px]."""
    places: dict[tuple[str, int], dict[str, tuple[float, float]]] = {}
    with path.open(newline="") as stream:
        for row in csv.DictReader(stream):
            key = (row["clip"], int(row["frame"]))
            places.setdefault(key, {})[row["point"]] = (float(row["x_px"]), float(row["y_px"]))
    names = list(next(iter(places.values())))
    clips: dict[str, dict[int, np.ndarray]] = {}
    for (clip, frame), points in places.items():
        clips.setdefault(clip, {})[frame] = np.array([points[name] for name in names])
    return names, clips


def read_reference(path: Path, names: list[str]) -> np.ndarray:
    """Return (T, P, 2) [px], NaN where blank."""
    with path.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    cells = [[row[f"{name}.{axis}"] or "nan" for name in names for axis in "xy"] for row in rows]
    return np.array(cells, float).reshape(len(rows), len(names), 2)


def follow(tracker: face_tracker.FaceTracker, path: Path) -> tuple[np.ndarray, np.ndarray, float]:
    """Return points (T, P, 2), their confidence (T, P) and the seconds of one core that it took."""
    begun = time.process_time()
    lost = np.full(len(tracker.frame.points), np.nan)
    points, trust, previous = [], [], None
    for _, picture in film.read_frames(path):
        found = face_tracker.track(tracker, picture, previous)
        previous = found.points if found else None
        points.append(found.points if found else np.stack([lost, lost], axis=1))
        trust.append(found.confidence if found else np.zeros(len(lost)))
    return np.array(points), np.array(trust), time.process_time() - begun


def score(points: np.ndarray, truth: np.ndarray, names: list[str]) -> dict[str, float]:
    """Return a clip's figures; frames without reference or without a face are left out."""
    both = np.isfinite(points).all(axis=(1, 2)) & np.isfinite(truth).all(axis=(1, 2))
    points, truth = points[both], truth[both]
    unit = np.linalg.norm(truth[:, names.index(EYES[0])] - truth[:, names.index(EYES[1])], axis=1)
    error = 100 * np.linalg.norm(points - truth, axis=2) / unit[:, None]
    mouth = [p for p, name in enumerate(names) if name.startswith(MOUTH)]
    inner = [p for p, name in enumerate(names) if name.startswith(INNER)]
    low, high = inner[len(inner) // 4], inner[3 * len(inner) // 4]
    found, true = (np.linalg.norm(x[:, low] - x[:, high], axis=1) / unit for x in (points, truth))
    return {
        "all points %": error.mean(),
        "mouth %": error[:, mouth].mean(),
        "constant %": 100
        * np.linalg.norm((points - truth).mean(axis=0), axis=1).mean()
        / unit.mean(),
        "opening corr.": np.corrcoef(found, true)[0, 1],
        "slope": np.polyfit(true, found, 1)[0],
    }


def table(data: Path) -> list[str]:
    """Return the lines of the trial's table, a row for each method."""
    names, labelled = read_labels(data / "labels.csv")
    films = {path.stem: path for path in sorted(data.iterdir()) if path.suffix in {".mpg", ".mp4"}}
    pictures, shapes = [], []
    for clip, frames in labelled.items():
        shown = film.frames_at(films[clip], frames, data / "labels.csv")
        pictures += [shown[frame] for frame in frames]
        shapes += list(frames.values())
    owners = [point_set.contour_of(name) for name in names]
    groups = point_groups.nested(owners, similarity.mean_shape(np.array(shapes), 1.0))
    tested = [clip for clip in films if clip not in labelled]
    lines = [f"{len(shapes)} labels of {len(labelled)} clips, tested on {len(tested)} other clips"]
    for method in tracker_training.METHODS:
        begun = time.process_time()
        tracker = tracker_training.train(pictures, np.array(shapes), groups, method, SEED)
        training = time.process_time() - begun
        scores, frames, seconds, missed = [], 0, 0.0, 0
        for clip in tested:
            points, _, spent = follow(tracker, films[clip])
            truth = read_reference(data / "reference" / f"{clip}.csv", names)
            scores.append(score(points, truth, names))
            frames, seconds = frames + len(points), seconds + spent
            missed += int(np.isnan(points).any(axis=(1, 2)).sum())
        mean = {key: np.mean([one[key] for one in scores]) for key in scores[0]}
        mean |= {"lost frames": missed, "frames/s": frames / seconds, "training s": training}
        if len(lines) == 1:
            lines.append("  ".join(["method".ljust(22), *(key.rjust(13) for key in mean)]))
        cells = [f"{value:13.3f}" for value in mean.values()]
        lines.append("  ".join([method.ljust(22), *cells]))
    return lines


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True, help="the folder")
    sys.stdout.write("\n".join(table(parser.parse_args().data)) + "\n")


if __name__ == "__main__":
    main()
