"""One take of curves, drawn at random, written as phones and other trackers write it."""

import csv
import json
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.files import shape_names

NAMES_TABLE = Path(__file__).parents[2] / "stages" / "tables" / "shape_names.tsv"
SHAPES = shape_names.read(NAMES_TABLE)
CANONICAL = [shape.name for shape in SHAPES]
# of Live Link Face: the order of the table, jaw and mouth to the right before the left
PASCAL = [shape.spellings["livelink"][0] for shape in SHAPES]
ANGLES = [
    *("HeadYaw", "HeadPitch", "HeadRoll"),
    *("LeftEyeYaw", "LeftEyePitch", "LeftEyeRoll"),
    *("RightEyeYaw", "RightEyePitch", "RightEyeRoll"),
]


class Take:
    """Curves (T, 52) in the order of the table, between 0 and a little more than 1."""

    def __init__(self, count=30, rate=Fraction(30), seed=0, dropped=(), start_s=47584.527):
        rng = np.random.default_rng(seed)
        self.values = rng.uniform(0, 1.05, (count, 52)).round(6)
        self.values[:, CANONICAL.index("mouthClose")] *= 0.2
        self.angles = rng.uniform(-0.5, 0.5, (count, 9)).round(6)
        self.rate, self.dropped, self.start_s = Fraction(rate), set(dropped), start_s
        self.times = [start_s + frame / float(self.rate) for frame in range(count)]

    def rows(self):
        """Frame, time [s] and curves of every frame that was not dropped."""
        for frame, (time, values) in enumerate(zip(self.times, self.values, strict=True)):
            if frame not in self.dropped:
                yield frame, time, values


def timecode(time_s):
    """Live Link Face's timecode, in sixtieths, of seconds from midnight."""
    ticks = round(time_s * 60000) % (86400 * 60000)
    seconds, part = divmod(ticks, 60000)
    minutes, seconds = divmod(seconds, 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours:02d}:{minutes:02d}:{seconds:02d}:{part // 1000:02d}.{part % 1000:03d}"


def live_link(take, folder, spelling="BlendShapeCount", tail="\n\n,,\n"):
    """A take of the phone, with blank rows at its end."""
    path = folder / "take.csv"
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["Timecode", spelling, *PASCAL, *ANGLES])
        for frame, time, values in take.rows():
            numbers = [f"{value:.10f}" for value in (*values, *take.angles[frame])]
            writer.writerow([timecode(time), 61, *numbers])
        stream.write(tail)
    return path


def arkit_json(take, folder):
    """A list of frames with a dictionary of weights."""
    frames = [
        {"frame": frame, "time": time, "blendShapes": dict(zip(CANONICAL, values, strict=True))}
        for frame, time, values in take.rows()
    ]
    path = folder / "take.json"
    path.write_text(json.dumps(frames))
    return path


def arrays_json(take, folder):
    """Names and a matrix, as audio to face tools write them."""
    about = {"exportFps": float(take.rate), "numPoses": 52, "facsNames": PASCAL}
    about["weightMat"] = take.values.tolist()
    path = folder / "matrix.json"
    path.write_text(json.dumps(about))
    return path


def arkit_csv(take, folder):
    """A wide table in Apple's raw spelling, semicolons and decimal commas."""
    spelled = [shape.spellings["ict"][0] if shape.spellings["ict"] else "" for shape in SHAPES]
    whole = {"browInnerUp_L": "browInnerUp", "cheekPuff_L": "cheekPuff", "": "tongueOut"}
    lines = [";".join(["timestamp_s", *(whole.get(name, name) for name in spelled)])]
    for _, time, values in take.rows():
        lines.append(";".join(f"{value:.6f}" for value in (time, *values)).replace(".", ","))
    path = folder / "arkit.csv"
    path.write_bytes(("\ufeff" + "\r\n".join(lines)).encode())
    return path


def mediapipe_json(take, folder):
    """The landmarker's categories, with _neutral first and without tongueOut."""
    order = [index for index, name in enumerate(CANONICAL) if name != "tongueOut"]
    lines = []
    for _, time, values in take.rows():
        categories = [{"index": 0, "score": 0.01, "categoryName": "_neutral", "displayName": ""}]
        categories += [
            {"index": place, "score": values[index], "categoryName": CANONICAL[index]}
            for place, index in enumerate(sorted(order, key=CANONICAL.__getitem__), start=1)
        ]
        found = [{"categories": categories, "headIndex": -1, "headName": ""}]
        lines.append(json.dumps({"timestampMs": 1000 * time, "faceBlendshapes": found}))
    path = folder / "blendshapes.jsonl"
    path.write_text("\n".join(lines))
    return path


def mediapipe_csv(take, folder):
    """A wide table of scores, times in whole milliseconds."""
    order = sorted(name for name in CANONICAL if name != "tongueOut")
    rows = [",".join(["frame", "timestamp_ms", "_neutral", *order])]
    for frame, time, values in take.rows():
        scores = [values[CANONICAL.index(name)] for name in order]
        rows.append(",".join(map(str, [frame, round(1000 * time), 0.001, *scores])))
    path = folder / "scores.csv"
    path.write_text("\n".join(rows) + "\n")
    return path


WRITERS = (live_link, arkit_json, arrays_json, arkit_csv, mediapipe_json, mediapipe_csv)
