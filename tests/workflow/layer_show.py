"""A show of marker takes of a face in layers, and of two characters they drive, made in a second.

The takes are those of `layer_face`; `b` has a film and a stretch without markers. `plain` is a mesh
with a pose for each extreme, `painted` one whose poses are tables of its own blendshapes.
"""

import av
import layer_face
import marker_show
import numpy as np
import tiny_show

FILM_RATE = 10
# of every take
TAKE = {"preview.mp4", "mesh.exr", "mesh.json", "mesh.pc2", "mesh.glb", "weights.csv"}
SOLVED = {"layers.parquet", "directed.parquet", "weights.parquet"}
LOST = (30, 36)  # frames of `b` without markers, from the film's first picture
MISSING = ("emotion", "rage")  # on the painted character
# (column, row) of the vertices that each blendshape of the painted character moves
SHAPES = {
    "browInnerUp": [(2, 6), (3, 6), (4, 6)],
    "browDownLeft": [(5, 6), (5, 7)],
    "eyeBlinkLeft": [(4, 5), (5, 5)],
    "eyeSquintLeft": [(4, 4), (5, 4)],
    "mouthClose": [(3, 1)],
    "jawOpen": [(2, 0), (3, 0), (4, 0)],
    "mouthSmileLeft": [(5, 2), (5, 1)],
}
POSES = {
    ("emotion", "joy"): {"mouthSmileLeft": 0.9, "eyeSquintLeft": 0.4},
    ("emotion", "surprise"): {"browInnerUp": 1.0, "jawOpen": 0.4},
    ("speech", "m"): {"mouthClose": 1.0},
    ("speech", "aa"): {"jawOpen": 1.0, "mouthClose": 0.1},
    ("blink", "half"): {"eyeBlinkLeft": 0.45, "eyeSquintLeft": 0.2},
    ("blink", "closed"): {"eyeBlinkLeft": 1.0},
}
MOST_BLINK = 0.25  # of the shape, by the painted character's channels
CHARACTERS = {
    # without what may draw a take away from its points
    "plain": {
        "neutral": "neutral.obj",
        "masks": "masks.tsv",
        "pivot": "0 0 -2",
        "face_unit": "8",
        "lip_sigma": "0",
        "temporal": "0",
        "lean": "0",
        "head": "none",
    },
    "painted": {
        "neutral": "neutral.obj",
        "masks": "masks.ply",
        "painted_masks": ",".join(layer_face.MASKS),
        "delivery_shapes": "shapes",
        "channels": "channels.tsv",
        "pivot": "0 0 -1",
        "face_unit": "2",
        "rate": "15",
        "head_gain": "1 0 1",
        "follow_s": "0.1",
        "tempo": "2",
        "gap_filling": "dynamics",
        "outputs": "livelink",
    },
}


def marker(x, y):
    """Return the name of the marker at a column and row."""
    return f"M{x}{y}"


def write_markers(path, shot):
    """Write a take as a wide table; `b` has a stretch without markers."""
    places = layer_face.marker_places(shot)
    names = [
        f"{marker(x, y)}_{axis}" for x, y in zip(*layer_face.grid(), strict=True) for axis in "xyz"
    ]
    rows = [("frame", "time_s", *names)]
    first, last = (round(layer_face.AHEAD_S * layer_face.RATE) + frame for frame in LOST)
    for frame, row in enumerate(places.reshape(len(places), -1)):
        lost = shot == "b" and first <= frame < last
        cells = [""] * len(row) if lost else [f"{value:.6f}" for value in row]
        rows.append((frame, f"{frame / layer_face.RATE:.6f}", *cells))
    tiny_show.write_table(path, rows, ",")


def write_film(path):
    """Write a film that darkens, with sound."""
    samples = marker_show.speech(1)[: round(layer_face.LENGTH_S * marker_show.SOUND_RATE)]
    with av.open(str(path), "w") as container:
        video = container.add_stream("libx264", rate=FILM_RATE, options={"threads": "1"})
        video.width = video.height = marker_show.SIZE
        video.pix_fmt = "yuv420p"
        audio = container.add_stream("aac", rate=marker_show.SOUND_RATE, layout="mono")
        for grey in np.linspace(200, 50, round(layer_face.LENGTH_S * FILM_RATE)):
            picture = np.full((marker_show.SIZE, marker_show.SIZE, 3), grey, np.uint8)
            container.mux(video.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(video.encode())
        marker_show.add_sound(container, audio, samples)


def corners():
    """Return the vertices of the plate's faces."""
    first = [
        layer_face.ROWS * i + j
        for i in range(layer_face.COLUMNS - 1)
        for j in range(layer_face.ROWS - 1)
    ]
    return [(v, v + layer_face.ROWS, v + layer_face.ROWS + 1, v + 1) for v in first]


def write_obj(path, vertices):
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = ["v {:.6f} {:.6f} {:.6f}".format(*vertex) for vertex in vertices]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in corners()]
    path.write_text("\n".join(lines) + "\n")


def write_ply(path, vertices, colours):
    """Write a mesh whose vertices are painted, (V, 3) in 0..1."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"property uchar {colour}" for colour in ("red", "green", "blue")]
    lines += [f"element face {len(corners())}", "property list uchar int vertex_indices"]
    lines.append("end_header")
    for vertex, colour in zip(vertices, np.rint(254 * colours).astype(int), strict=True):
        lines.append("{:.6f} {:.6f} {:.6f} {} {} {}".format(*vertex, *colour))
    lines += ["4 " + " ".join(map(str, face)) for face in corners()]
    path.write_text("\n".join(lines) + "\n")


def write_plain(folder):
    """Write a plate with a table of masks and a pose for each extreme."""
    write_obj(folder / "neutral.obj", layer_face.neutral(2.0, 0.1))
    for (layer, name), offset in zip(layer_face.EXTREMES, layer_face.poses(2, 2.0), strict=True):
        write_obj(folder / "poses" / f"{layer}_{name}.obj", layer_face.neutral(2.0, 0.1) + offset)
    rows = [
        (vertex, mask, f"{weight:g}")
        for mask, weights in zip(layer_face.MASKS, layer_face.masks(), strict=True)
        for vertex, weight in enumerate(weights)
        if weight
    ]
    tiny_show.write_table(folder / "masks.tsv", [("vertex", "region", "weight"), *rows])


def write_painted(folder):
    """Write a plate with painted masks, blendshapes, and poses as tables of them."""
    rest = layer_face.neutral(0.5, 0.3)
    write_obj(folder / "neutral.obj", rest)
    write_ply(folder / "masks.ply", rest, layer_face.masks().T)
    for number, (name, places) in enumerate(SHAPES.items()):
        shape = rest.copy()
        for x, y in places:
            shape[layer_face.ROWS * x + y] += 0.3, 0.1 * number, -0.2
        write_obj(folder / "shapes" / f"{name}.obj", shape)
    for (layer, name), mix in POSES.items():
        table = [("name", "value"), *mix.items()]
        tiny_show.write_table(folder / "poses" / f"{layer}_{name}.csv", table, ",")
    limits = [("shape", "high"), ("eyeBlinkLeft", MOST_BLINK)]
    tiny_show.write_table(folder / "channels.tsv", limits)


def character_rows():
    """Return the rows of characters.tsv, blank where nothing is asked."""
    columns = list(dict.fromkeys(column for cells in CHARACTERS.values() for column in cells))
    rows = [("character", "method", "folder", "unit", "up_axis", *columns)]
    for name, cells in CHARACTERS.items():
        row = [cells.get(column, "") for column in columns]
        rows.append((name, "layers", name, "cm", "y", *row))
    return rows


def extreme_rows(actor, shot):
    """Return an actor's rows of expressions.tsv; all rests are the neutral frame."""
    rests = [(actor, layer, name, shot, 0) for layer, name in layer_face.RESTS.items()]
    return rests + [(actor, *extreme, shot, peak) for extreme, peak in layer_face.PEAKS.items()]


def mask_rows(actor):
    """Return an actor's rows of actor_masks.tsv."""
    rows = [(actor, "upper", "*", "")]
    for x, y in zip(*layer_face.grid(), strict=True):
        if y <= 3:
            rows.append((actor, "mouth", marker(x, y), 0.5 if y == 3 else ""))
        elif y <= 5:
            rows.append((actor, "eyes", marker(x, y), ""))
    return rows


def build(folder):
    """Write the show into a folder: takes `a` and `b` of eve; lea plays nobody."""
    footage = folder / "footage"
    footage.mkdir(parents=True)
    write_film(footage / "b.mp4")
    for shot in "ab":
        write_markers(footage / f"{shot}.csv", shot)
    write_plain(folder / "plain")
    write_painted(folder / "painted")
    session = "session actor neutral_shot neutral_frame unit_markers marker_unit lip_points"
    tables = {
        "shots": [
            ("shot", "session", "video", "markers", "sync_offset_s", "basis"),
            ("a", "s1", "", "footage/a.csv", "", "yes"),
            ("b", "s1", "footage/b.mp4", "footage/b.csv", -layer_face.AHEAD_S, ""),
            ("c", "s2", "", "footage/a.csv", "", "yes"),
        ],
        "sessions": [
            session.split(),
            ("s1", "eve", "a", "0", "M04,M64", "mm", "M32,M31"),
            ("s2", "lea", "c", "0", "M04,M64", "mm", "M32,M31"),
        ],
        "characters": character_rows(),
        "cast": [
            ("actor", "character", "points", "shots"),
            ("eve", "plain", "markers", "b"),
            ("eve", "painted", "markers", "b"),
        ],
        "expressions": [
            ("actor", "layer", "name", "shot", "frame"),
            *extreme_rows("eve", "a"),
            *extreme_rows("lea", "c"),
        ],
        "actor_masks": [("actor", "mask", "point", "weight"), *mask_rows("eve"), *mask_rows("lea")],
        "directing": [("character", "shot", "layer", "name", "gain", "start_s", "end_s", "fade_s")],
        "regions": [("region", "point", "weight"), ("mouth", "lips", "1")],
        "region_settings": [("region", "count"), ("mouth", "2")],
        "key_shapes": [("actor", "region", "shot", "frame", "state")],
        "point_set": [("contour", "kind", "count"), ("lips", "closed", "8")],
    }
    for name, rows in tables.items():
        tiny_show.write_table(folder / "config" / f"{name}.tsv", rows)
    (folder / "config" / "config.yaml").write_text(
        "tracker_method: eigen_points_descent\nmin_confidence: 0.3\nmax_marker_gap_s: 0.1\n"
        "seed: 1\n"
    )


def edit(path, old, new):
    """Put other words into a file."""
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def add(path, *cells):
    """Add a row to a table."""
    with path.open("a") as table:
        table.write("\t".join(map(str, cells)) + "\n")


def take(show, character):
    """Return the folder of the character's take `b`."""
    return show.folder / "results/takes/b" / character


def names_in(folder):
    """Return the paths of all that is in a folder."""
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*")}
