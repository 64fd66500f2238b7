"""Two public rigs as folders of OBJ, with the places that points of trackers stand for.

The ICT rig names the vertices of 68 landmarks, which are ibug's. Contours of other trackers follow
the same lines with other numbers of points: each of theirs lies between two landmarks, as far along
the contour. A closed brow follows the landmarks with its upper line, which its first half is.
"""

import itertools
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stages.files import delimited

TABLES = Path(__file__).resolve().parents[1] / "stages" / "tables"
RIGS = {
    "ict": "ict-facekit/ict_face_rig.npz",
    "facecap": "facecap-head/facecap_head_rig.npz",
}
EYES = slice(36, 42), slice(42, 48)


class Described(NamedTuple):
    """Hold a rig that is written: its name, folder, landmark vertices and face unit [cm]."""

    name: str
    folder: Path
    landmarks: np.ndarray
    face_unit: float


def write(data: Path, folder: Path) -> list[Described]:
    """Write the rigs that a folder of data holds."""
    made = []
    for name, file in RIGS.items():
        if not (data / file).is_file():
            continue
        stored = np.load(data / file)
        place = folder / name
        landmarks = stored["landmark68"] if "landmark68" in stored else np.zeros(0, int)
        neutral = stored["neutral"].astype(float)
        unit = np.ptp(neutral[:, 0]) / 3
        if len(landmarks):
            middles = [neutral[landmarks[eye]].mean(axis=0) for eye in EYES]
            unit = np.linalg.norm(middles[0] - middles[1])
            for tracker in ("ibug68", "mediapipe"):
                write_places(place / f"{tracker}.tsv", tracker, landmarks)
        (place / "shapes").mkdir(parents=True, exist_ok=True)
        # a triangle among quads ends in -1
        faces = "".join(
            f"f {' '.join(map(str, face[face >= 0] + 1))}\n" for face in stored["faces"]
        )
        write_obj(place / "neutral.obj", neutral, faces)
        for shape, delta in zip(stored["names"], stored["deltas"], strict=True):
            write_obj(place / "shapes" / f"{shape}.obj", neutral + delta, faces)
        made.append(Described(name, place, landmarks, float(unit)))
    return made


def write_obj(path: Path, vertices: np.ndarray, faces: str) -> None:
    """Write a mesh."""
    lines = [f"v {x:.7g} {y:.7g} {z:.7g}\n" for x, y, z in vertices]
    path.write_text("".join(lines) + faces)


def contours(tracker: str) -> dict[str, list[int]]:
    """Return the indices of each contour of a tracker, in order along it."""
    rows = delimited.read(TABLES / "landmarks" / f"{tracker}.tsv", ("index", "point"))
    found: dict[str, list[int]] = {}
    for row in rows:
        found.setdefault(row.cells["point"].rpartition("_")[0], []).append(int(row.cells["index"]))
    return found


def write_places(path: Path, tracker: str, landmarks: np.ndarray) -> None:
    """Write where the points of a tracker lie between the landmarks of a rig."""
    known, lines = contours("ibug68"), ["point\tvertex\tshares\n"]
    for contour, points in contours(tracker).items():
        if contour not in known:
            continue
        vertices, count = landmarks[known[contour]], len(points)
        is_open = contour.startswith("brow")
        if is_open:
            vertices, count = vertices.tolist(), min(count, len(vertices))
            places = np.linspace(0, len(vertices) - 1, count)
        else:
            places = np.arange(count) * len(vertices) / count
            vertices = [*vertices.tolist(), int(vertices[0])]
        pairs = list(itertools.pairwise([*vertices, vertices[-1]]))
        for number, along in enumerate(places):
            low, high = pairs[int(along)]
            part = along - int(along)
            cells = (f"{low},{high}", f"{1 - part:.6f},{part:.6f}") if part else (low, 1)
            lines.append(f"{contour}_{number:02d}\t{cells[0]}\t{cells[1]}\n")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(lines))
