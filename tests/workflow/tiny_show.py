"""A show of two short films of a drawn face and one character, made in a second."""

import av
import cv2
import numpy as np

SIZE, FRAMES = 144, 26
LABELLED = (0, 4, 9, 14, 19, 24)
LOCKS = {"mouth": (0, 9, 14), "eyes": (0, 4, 19), "pupils": (0, 9)}
POINT_SET = [
    ("brow_right", "open", "4"),
    ("brow_left", "open", "4"),
    ("eye_right", "closed", "8"),
    ("eye_left", "closed", "8"),
    ("pupil_right", "point", "1"),
    ("pupil_left", "point", "1"),
    ("lips_outer", "closed", "12"),
    ("lips_inner", "closed", "8"),
]
REGIONS = [
    ("mouth", "lips_outer", "1"),
    ("mouth", "lips_inner", "1"),
    ("eyes", "eye_right", "1"),
    ("eyes", "eye_left", "1"),
    ("eyes", "brow_right", "1"),
    ("eyes", "brow_left", "1"),
    ("pupils", "pupil_right", "1"),
    ("pupils", "pupil_left", "1"),
]


def ellipse(centre, radii, count):
    """Return points of an ellipse from its left corner, along the lower side first."""
    angle = np.pi - 2 * np.pi * np.arange(count) / count
    return np.array(centre) + np.array(radii) * np.stack([np.cos(angle), np.sin(angle)], -1)


def contours(frame, phase):
    """Return the contours [px] of a face whose mouth, lids and brows move."""
    opening = 5.5 + 4 * np.sin(0.5 * frame + phase)
    lid = 4.2 + 2.4 * np.sin(0.31 * frame + 2 * phase)
    raised = 3 * np.sin(0.7 * frame + phase)
    gaze = 3 * np.sin(0.43 * frame + phase)
    move = np.array([72 + 3 * np.sin(0.2 * frame + phase), 72 + 2 * np.cos(0.17 * frame)])
    face = {
        "lips_outer": ellipse((0, 30), (20, opening + 5), 16),
        "lips_inner": ellipse((0, 30), (15, opening), 12),
    }
    for side, x in (("right", -22), ("left", 22)):
        face[f"eye_{side}"] = ellipse((x, -14), (11, lid), 12)
        along = np.linspace(-12, 12, 6) * (1 if side == "right" else -1)
        face[f"brow_{side}"] = np.stack([x + along, -29 - raised - along * 0 + 0.02 * along**2], -1)
        face[f"pupil_{side}"] = np.array([[x + gaze, -14.0]])
    return {name: points + move for name, points in face.items()}


def draw(face, skin):
    """Return the picture of a face."""
    picture = skin.copy()

    def fill(points, colour):
        cv2.fillPoly(picture, [np.round((points - 0.5) * 16).astype(int)], colour, cv2.LINE_AA, 4)

    fill(face["lips_outer"], (150, 60, 60))
    fill(face["lips_inner"], (40, 10, 10))
    for side in ("right", "left"):
        fill(face[f"eye_{side}"], (240, 240, 240))
        centre = np.round((face[f"pupil_{side}"][0] - 0.5) * 16).astype(int)
        cv2.circle(picture, tuple(int(c) for c in centre), 4 * 16, (40, 60, 90), -1, cv2.LINE_AA, 4)
        line = np.round((face[f"brow_{side}"] - 0.5) * 16).astype(int)
        cv2.polylines(picture, [line], False, (60, 40, 30), 3, cv2.LINE_AA, 4)
    return picture


def write_film(path, phase):
    """Write a film; return its contours on every frame."""
    rng = np.random.default_rng(1)
    noise = cv2.GaussianBlur(rng.normal(0, 40, (SIZE, SIZE, 3)), (0, 0), 2)
    skin = np.clip(np.array([205, 165, 140]) + noise, 0, 255).astype(np.uint8)
    faces = [contours(frame, phase) for frame in range(FRAMES)]
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=25, options={"crf": "16", "threads": "1"})
        stream.width = stream.height = SIZE
        stream.pix_fmt = "yuv420p"
        for face in faces:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(draw(face, skin), "rgb24")))
        container.mux(stream.encode())
    return faces


def write_table(path, rows, separator="\t"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(separator.join(map(str, row)) + "\n" for row in rows))


def write_labels(path, faces):
    rows = [("frame", "point", "x_px", "y_px", "corner")]
    for frame in LABELLED:
        for name, points in faces[frame].items():
            closed = name.startswith(("eye", "lips"))
            for index, (x, y) in enumerate(points):
                point = name if len(points) == 1 else f"{name}_{index:02d}"
                corner = "1" if closed and index in (0, len(points) // 2) else ""
                rows.append((frame, point, f"{x:.2f}", f"{y:.2f}", corner))
    write_table(path, rows, ",")


def write_character(folder):
    """Write a plate of 30 vertices and a sculpt of it for each locked key shape."""
    rng = np.random.default_rng(2)
    grid = np.stack(np.meshgrid(np.arange(5.0), np.arange(6.0), indexing="ij"), -1).reshape(-1, 2)
    neutral = np.concatenate([grid, 0.1 * rng.normal(size=(30, 1))], axis=1)
    first = [6 * i + j for i in range(4) for j in range(5)]
    corners = [(v, v + 6, v + 7, v + 1) for v in first]

    def write_mesh(path, vertices):
        lines = ["v {:.5f} {:.5f} {:.5f}".format(*vertex) for vertex in vertices]
        lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in corners]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(lines) + "\n")

    write_mesh(folder / "neutral.obj", neutral)
    for region, frames in LOCKS.items():
        for frame in frames:
            sculpt = neutral + rng.normal(0, 0.3, neutral.shape)
            write_mesh(folder / "sculpts" / region / f"a_f{frame:04d}.obj", sculpt)
    masks = [("region", "axis", "from", "to", "vertices"), ("mouth", "", "", "", "")]
    masks += [("eyes", "y", "2", "3", ""), ("pupils", "", "", "", "28,29")]
    write_table(folder / "masks.tsv", masks)


def build(folder):
    """Write the show into a folder."""
    (folder / "footage").mkdir(parents=True)
    for shot, phase in (("a", 0.0), ("b", 1.3)):
        faces = write_film(folder / "footage" / f"{shot}.mp4", phase)
        if shot == "a":
            write_labels(folder / "footage" / "a.csv", faces)
    write_character(folder / "plate")
    config = folder / "config"
    tables = {
        "shots": [
            ("shot", "session", "video", "labels", "basis"),
            ("a", "s1", "footage/a.mp4", "footage/a.csv", "yes"),
            ("b", "s1", "footage/b.mp4", "", ""),
        ],
        "sessions": [
            ("session", "actor", "neutral_shot", "neutral_frame"),
            ("s1", "eve", "a", "0"),
        ],
        "regions": [("region", "point", "weight"), *REGIONS],
        "region_settings": [("region", "count"), *((r, len(f)) for r, f in LOCKS.items())],
        "key_shapes": [("actor", "region", "shot", "frame", "state")]
        + [("eve", r, "a", f, "locked") for r, frames in LOCKS.items() for f in frames],
        "characters": [
            ("character", "folder", "neutral", "masks", "unit", "up_axis", "pivot", "face_unit"),
            ("plate", "plate", "neutral.obj", "masks.tsv", "cm", "y", "2 3 0", "2"),
        ],
        "cast": [("actor", "character", "shots"), ("eve", "plate", "")],
        "point_set": [("contour", "kind", "count"), *POINT_SET],
    }
    for name, rows in tables.items():
        write_table(config / f"{name}.tsv", rows)
    (config / "config.yaml").write_text(
        "tracker_method: eigen_points_descent\nmin_confidence: 0.3\nseed: 1\n"
    )
