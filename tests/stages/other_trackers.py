"""One take of landmarks, drawn at random, written as each tracker writes it."""

import csv
import json
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.files import film_writer, landmark_map

TABLES = Path(__file__).parents[2] / "stages" / "tables"
MAPS = [str(path) for path in sorted((TABLES / "landmarks").glob("*.tsv"))]
# the mesh's counterparts of the 68 points
IBUG = [
    *(127, 234, 93, 132, 58, 172, 136, 150, 176, 148, 152, 377, 400, 379, 365, 397, 356),
    *(70, 63, 105, 66, 107, 336, 296, 334, 293, 300, 168, 6, 195, 4, 240, 75, 1, 305, 460),
    *(33, 160, 158, 133, 153, 144, 362, 385, 387, 263, 373, 380),
    *(61, 39, 37, 0, 267, 269, 291, 405, 314, 17, 84, 181, 78, 82, 13, 312, 308, 317, 14, 87),
]
WIDTH, HEIGHT = 320, 240
MAPS_OF = {Path(path).stem: landmark_map.read(path) for path in MAPS}


class Take:
    """Points (T, 478, 2) [px], the centre of the first pixel (0.5, 0.5), lost on some frames."""

    def __init__(self, count=9, rate=Fraction(25), lost=(3,), seed=0):
        rng = np.random.default_rng(seed)
        self.points = rng.uniform(20, 200, (1, 478, 2)) + rng.normal(0, 2, (count, 478, 2))
        self.rate, self.lost = rate, set(lost)
        self.times = [float(frame / rate) for frame in range(count)]

    def expected(self, tracker):
        """Names and points (T, P, 2) as they should be read."""
        whole = self.points if tracker == "mediapipe" else self.points[:, IBUG]
        chosen = MAPS_OF[tracker]
        points = whole[:, list(chosen.values())].copy()
        points[sorted(self.lost)] = np.nan
        return list(chosen), points

    def faces(self):
        """Frame number, time [s], and the points or None."""
        for frame, (time, points) in enumerate(zip(self.times, self.points, strict=True)):
            yield frame, time, None if frame in self.lost else points

    def film(self, path):
        """Write a film of the take's frames."""
        grey = np.full((HEIGHT, WIDTH, 3), 90, np.uint8)
        film_writer.write(path, ((time, grey) for time in self.times), (WIDTH, HEIGHT), self.rate)
        return str(path)


def _normalised(points):
    return [
        {"x": round(x / WIDTH, 7), "y": round(y / HEIGHT, 7), "z": 0.0}
        for x, y in ([] if points is None else points)
    ]


def mediapipe_json(take, folder):
    """A list of frames under a key, times in milliseconds."""
    frames = [
        {"frame": frame, "timestamp_ms": round(1000 * time), "landmarks": _normalised(points)}
        for frame, time, points in take.faces()
    ]
    path = folder / "landmarks.json"
    path.write_text(json.dumps({"model": "face_landmarker", "frames": frames}))
    return path


def mediapipe_lines(take, folder):
    """The result of the web's landmarker on each line."""
    path = folder / "landmarks.jsonl"
    lines = [
        {"timestampMs": 1000 * time, "faceLandmarks": [] if points is None else [found]}
        for _, time, points in take.faces()
        for found in [_normalised(points)]
    ]
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    return path


def mediapipe_flat(take, folder):
    """Frames of flat numbers [px] without times; only the rate."""
    frames = [
        [] if points is None else np.round(np.pad(points, ((0, 0), (0, 1))), 4).ravel().tolist()
        for _, _, points in take.faces()
    ]
    path = folder / "flat.json"
    path.write_text(json.dumps({"fps": float(take.rate), "landmarks": frames}, indent=1))
    return path


def _rows(path, header, rows, delimiter=",", encoding="utf-8", end="\n"):
    with path.open("w", newline="", encoding=encoding) as stream:
        writer = csv.writer(stream, delimiter=delimiter, lineterminator=end)
        writer.writerow(header)
        writer.writerows(rows)
    return path


def mediapipe_wide(take, folder):
    """A wide table with a decimal comma, a byte order mark and DOS line ends."""
    header = ["frame", "time_s", *(f"{axis}_{i}" for i in range(478) for axis in "xyz")]
    rows = [
        [frame, f"{time:.6f}".replace(".", ",")]
        + [
            "" if points is None else f"{value:.7f}".replace(".", ",")
            for i in range(478)
            for value in (
                (0, 0, 0) if points is None else (points[i, 0] / WIDTH, points[i, 1] / HEIGHT, 0.0)
            )
        ]
        for frame, time, points in take.faces()
    ]
    return _rows(folder / "wide.csv", header, rows, ";", "utf-8-sig", "\r\n")


def mediapipe_long(take, folder):
    """A row for each point [px]; frames without a face have none."""
    rows = [
        [frame, index, f"{x:.4f}", f"{y:.4f}", 0]
        for frame, _, points in take.faces()
        if points is not None
        for index, (x, y) in enumerate(points)
    ]
    return _rows(folder / "long.csv", ["frame", "landmark_index", "x", "y", "z"], rows)


def openface(take, folder):
    """Blanks in the header, frames from 1, times that are no film's, zeros where it failed."""
    names = [f"{axis}_{i}" for axis in "xyXYZ" for i in range(68)]
    header = ["frame", " face_id", " timestamp", " confidence", " success"]
    rows = []
    for frame, _, points in take.faces():
        found = points is not None
        pixels = take.points[frame, IBUG] - 0.5 if found else np.zeros((68, 2))
        values = [*pixels[:, 0], *pixels[:, 1], *[40.0] * 204]
        row = [frame + 1, 0, f"{0.001 * frame:.3f}", 0.98 if found else 0.1, int(found)]
        rows.append([*row, *(f"{value:.3f}" for value in values)])
    return _rows(folder / "openface.csv", header + [f" {name}" for name in names], rows)


def pyfeat(take, folder):
    """The mesh and the 68 points of it, the picture's size, coarse times."""
    header = ["FaceRectX", "FaceScore", *(f"{axis}_{i}" for axis in "xy" for i in range(68))]
    header += ["Pitch", *(f"mesh_{axis}_{i}" for axis in "xyz" for i in range(478))]
    header += ["FrameHeight", "FrameWidth", "input", "frame", "approx_time"]
    rows = []
    for frame, time, points in take.faces():
        mesh = np.full((478, 2), np.nan) if points is None else points
        values = [*mesh[IBUG].T.ravel(), 0.1, *mesh.T.ravel(), *[0.0] * 478]
        cells = ["" if np.isnan(value) else f"{value:.4f}" for value in values]
        end = [HEIGHT, WIDTH, "a, b.mp4", frame, f"00:{int(time):02d}"]
        rows.append([12.5, 0.99, *cells, *end])
    return _rows(folder / "fex.csv", header, rows)


def ibug(take, folder):
    """A folder of .pts files, counted from 1; frames without a face have none."""
    folder = folder / "pts"
    folder.mkdir()
    for frame, _, points in take.faces():
        if points is None:
            continue
        lines = "\n".join(f"{x:.3f} {y:.3f}" for x, y in points[IBUG] + 0.5)
        text = f"version: 1\nn_points:  68\n{{\n{lines}\n}}\n"
        (folder / f"film_{frame + 1:04d}.pts").write_text(text)
    return folder


def keyface(take, folder):
    """The project's own wide table."""
    names, points = take.expected("mediapipe")
    header = ["frame", *(f"{name}.{axis}" for name in names for axis in "xy")]
    rows = [
        [frame, *("" if np.isnan(value) else f"{value:.4f}" for value in face.ravel())]
        for frame, face in enumerate(points)
    ]
    return _rows(folder / "own.csv", header, rows)


# writer -> the tracker it stands for, and the error that its digits allow [px]
WRITERS = {
    mediapipe_json: ("mediapipe", 0.6e-7 * WIDTH),
    mediapipe_lines: ("mediapipe", 0.6e-7 * WIDTH),
    mediapipe_flat: ("mediapipe", 0.6e-4),
    mediapipe_wide: ("mediapipe", 0.6e-7 * WIDTH),
    mediapipe_long: ("mediapipe", 0.6e-4),
    openface: ("ibug68", 0.6e-3),
    pyfeat: ("mediapipe", 0.6e-4),
    ibug: ("ibug68", 0.6e-3),
    keyface: ("mediapipe", 0.6e-4),
}
