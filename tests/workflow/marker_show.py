"""A show of marker takes, one with a film, and of a rig that is tuned by pairs, made in a second.

The rig is a plate. Markers stand on most of its vertices, and move as its three shapes do, by
weights that are planted, with a head that turns. Times are those of the film, which starts
`AHEAD_S` after the markers.
"""

from fractions import Fraction

import av
import cv2
import numpy as np
import tiny_show

RATE, FILM_RATE, SOUND_RATE = 120, 15, 16000
AHEAD_S = 0.4
FILM_S, LENGTH_S = 3.0, {"a": 4.0, "b": 1.5}  # of the film, of the markers
SHAPES = ("browInnerUp", "jawOpen", "mouthSmileLeft")
TUNED = tuple(range(2, 350, 31))  # frames of `a`, from the film's first picture
REFERENCES = "8"  # frames to tune
MM = 30.0  # of the actor's face where the plate has 1
COLUMNS, ROWS = 5, 6
WITH_MARKERS = [v for v in range(COLUMNS * ROWS) if v % ROWS not in (1, 5)]
FIXED = {v: f"M{v % ROWS}{v // ROWS}" for v in WITH_MARKERS}
SIZE = 96
SESSION_COLUMNS = "session actor neutral_shot neutral_frame unit_markers marker_unit lip_points"
CHARACTER_COLUMNS = (
    "character method folder neutral masks unit up_axis pivot face_unit rate references "
    "virtual_markers channels smoothing"
)


def weights(shot, time_s):
    """Return the planted weights (T, 3) at times on the film's clock; none move before it."""
    speed = {"a": (0.75, 1.3, 2.1), "b": (1.7, 0.9, 1.2)}[shot]
    phase = 2 * np.pi * np.maximum(time_s, 0)[:, None] * np.array(speed)
    return 0.45 * (1 - np.cos(phase))


def plate():
    """Return neutral (30, 3) and shapes (3, 30, 3) of the rig; some vertices never move."""
    x, y = (grid.ravel() for grid in np.indices((COLUMNS, ROWS), float))
    neutral = np.stack([x - 2, y - 3, 1 - 0.3 * (x - 2) ** 2 - 0.1 * (y - 3) ** 2], axis=1)
    shapes = np.zeros((3, *neutral.shape))
    shapes[0, (y == 4) & (abs(x - 2) < 2)] = 0.05, 0.4, 0.1
    shapes[1, y <= 1] = 0, -0.8, 0.2
    shapes[2, (y == 2) & (x >= 2)] = 0.4, 0.3, -0.1
    shapes[1, (y == 2) & (x >= 2)] = 0, -0.2, 0
    return neutral, shapes


def marker_places(shot):
    """Return places (T, P, 3) [mm] of a take's markers, from the markers' first frame."""
    neutral, shapes = plate()
    start_s = AHEAD_S if shot == "a" else 0.0
    time_s = np.arange(round(LENGTH_S[shot] * RATE)) / RATE - start_s
    face = MM * (neutral + np.tensordot(weights(shot, time_s), shapes, 1))[:, WITH_MARKERS]
    noise = np.random.default_rng(ord(shot)).normal(0, 0.03, face.shape)
    turn = 0.2 * np.sin(2 * np.pi * 0.6 * np.maximum(time_s, 0))
    cosine, sine, none = np.cos(turn), np.sin(turn), np.zeros(len(turn))
    about_y = np.array([[cosine, none, sine], [none, none + 1, none], [-sine, none, cosine]])
    moved = np.einsum("ijt,tpj->tpi", about_y, face + noise)
    return moved + np.stack([20 * turn, 1500 + 10 * turn, none], axis=1)[:, None]


def write_markers(path, shot):
    """Write a take as a wide table, its columns in an order of their own."""
    places = marker_places(shot)
    names = [f"{name}_{axis}" for axis in "zxy" for name in FIXED.values()]
    values = np.concatenate([places[..., axis] for axis in (2, 0, 1)], axis=1)
    rows = [("frame", "time_s", *names)]
    for frame, row in enumerate(values):
        rows.append((frame, f"{frame / RATE:.6f}", *(f"{value:.3f}" for value in row)))
    tiny_show.write_table(path, rows, ",")


def speech(seed):
    """Return bursts of noise, four a second, with pauses, as long as the longest take."""
    rng = np.random.default_rng(seed)
    syllables = rng.random(round(LENGTH_S["a"] * 4) + 2)
    syllables *= rng.random(len(syllables)) < 0.7
    count = round(LENGTH_S["a"] * SOUND_RATE)
    envelope = np.interp(np.arange(count) / SOUND_RATE * 4, np.arange(len(syllables)), syllables)
    return 0.2 * envelope * np.convolve(rng.standard_normal(count), np.ones(4) / 2, "same")


def add_sound(container, stream, samples):
    for first in range(0, len(samples), 1024):
        values = (samples[None, first : first + 1024] * 32767).astype(np.int16)
        frame = av.AudioFrame.from_ndarray(values, "s16", "mono")
        frame.sample_rate, frame.pts = SOUND_RATE, first
        frame.time_base = Fraction(1, SOUND_RATE)
        container.mux(stream.encode(frame))
    container.mux(stream.encode())


def write_wav(path, samples):
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=SOUND_RATE, layout="mono")
        add_sound(container, stream, samples)


def write_film(path, samples):
    """Write a film of a disc that opens with the jaw."""
    time_s = np.arange(round(FILM_S * FILM_RATE)) / FILM_RATE
    with av.open(str(path), "w") as container:
        video = container.add_stream("libx264", rate=FILM_RATE, options={"threads": "1"})
        video.width, video.height, video.pix_fmt = SIZE, SIZE, "yuv420p"
        audio = container.add_stream("aac", rate=SOUND_RATE, layout="mono")
        for opening in weights("a", time_s)[:, 1]:
            picture = np.full((SIZE, SIZE, 3), 90, np.uint8)
            cv2.ellipse(
                picture, (48, 60), (20, 2 + int(20 * opening)), 0, 0, 360, (200, 80, 80), -1
            )
            container.mux(video.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(video.encode())
        add_sound(container, audio, samples)


def write_rig(folder):
    """Write neutral, shapes, virtual markers, channels and pairs of the plate."""
    neutral, shapes = plate()
    first = [ROWS * i + j for i in range(COLUMNS - 1) for j in range(ROWS - 1)]
    corners = [(v, v + ROWS, v + ROWS + 1, v + 1) for v in first]
    (folder / "shapes").mkdir(parents=True)
    for path, offsets in (
        (folder / "neutral.obj", 0),
        *((folder / "shapes" / f"{name}.obj", s) for name, s in zip(SHAPES, shapes, strict=True)),
    ):
        lines = ["v {:.5f} {:.5f} {:.5f}".format(*vertex) for vertex in neutral + offsets]
        lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in corners]
        path.write_text("\n".join(lines) + "\n")
    tiny_show.write_table(
        folder / "virtual_markers.tsv", [("point", "vertex"), *((m, v) for v, m in FIXED.items())]
    )
    tiny_show.write_table(folder / "channels.tsv", [("shape", "smoothing"), ("jawOpen", "0.5")])
    tuned = weights("a", np.array(TUNED) / RATE)
    rows = [("a", f, *(f"{w:.3f}" for w in row)) for f, row in zip(TUNED, tuned, strict=True)]
    tiny_show.write_table(folder / "pairs" / "ann.tsv", [("shot", "frame", *SHAPES), *rows])


def write_live_link(path, count=60):
    """Write a phone's take at 60 frames/s; return its curves (T, 3)."""
    curves = weights("a", np.arange(count) / 60).round(4)
    rows = [
        ("Timecode", "BlendShapeCount", "BrowInnerUp", "JawOpen", "MouthSmileLeft", "CheekPuff")
    ]
    for frame, row in enumerate(curves):
        timecode = f"10:20:{30 + frame // 60:02d}:{frame % 60:02d}.000"
        rows.append((timecode, 61, *row, 0.1))
    tiny_show.write_table(path, rows, ",")
    return curves


def build(folder):
    """Write the show into a folder: takes `a` and `b` of eve, curves `phone` of lea."""
    footage = folder / "footage"
    footage.mkdir(parents=True)
    sound = speech(1)
    shown = sound[round(AHEAD_S * SOUND_RATE) :][: round(FILM_S * SOUND_RATE)]
    write_film(footage / "a.mp4", shown)
    write_wav(footage / "a.wav", sound)
    write_wav(footage / "b.wav", speech(2))
    for shot in LENGTH_S:
        write_markers(footage / f"{shot}.csv", shot)
    write_live_link(footage / "phone.csv")
    write_rig(folder / "plate")
    rig = ("plate", "neutral.obj", "", "cm", "y", "0 0 -2", "4", str(FILM_RATE), REFERENCES)
    tables = {
        "shots": [
            ("shot", "session", "video", "markers", "sound", "sync_offset_s", "curves", "basis"),
            ("a", "s1", "footage/a.mp4", "footage/a.csv", "footage/a.wav", "", "", "yes"),
            ("b", "s1", "", "footage/b.csv", "", "", "", ""),
            ("phone", "s2", "", "", "", "", "footage/phone.csv", "yes"),
        ],
        "sessions": [
            SESSION_COLUMNS.split(),
            ("s1", "eve", "a", "0", "M30,M34", "mm", "M22,M02"),
            ("s2", "lea", "phone", "0", "", "", ""),
        ],
        "characters": [
            CHARACTER_COLUMNS.split(),
            ("tuned", "rbf", *rig, "", "channels.tsv", "multiresolution"),
            ("solved", "blendshapes", *rig, "virtual_markers.tsv", "", "none"),
        ],
        "cast": [
            ("actor", "character", "points", "shots"),
            ("eve", "tuned", "markers", ""),
            ("eve", "solved", "markers", ""),
            ("lea", "tuned", "curves", ""),
        ],
        "regions": [("region", "point", "weight"), ("mouth", "lips", "1")],
        "region_settings": [("region", "count"), ("mouth", "2")],
        "key_shapes": [("actor", "region", "shot", "frame", "state")],
        "point_set": [("contour", "kind", "count"), ("lips", "closed", "8")],
    }
    for name, rows in tables.items():
        tiny_show.write_table(folder / "config" / f"{name}.tsv", rows)
    (folder / "config" / "config.yaml").write_text(
        "tracker_method: eigen_points_descent\nmin_confidence: 0.3\nseed: 1\n"
    )
