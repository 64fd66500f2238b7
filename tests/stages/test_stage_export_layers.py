import csv
from fractions import Fraction

import numpy as np
import pytest
from small_take import words

from stages import export_layers
from stages.core import local_shapes
from stages.files import errors, rig, weights

RATE = Fraction(30000, 1001)
FIRST, FRAMES = 12, 20
# masks may have underscores; extremes are called after their layer
COLUMNS = [
    "upper_face.emotion_joy",
    "upper_face.speech_m",
    "mouth.emotion_joy",
    "mouth.speech_m",
    "mouth.speech_aa",
]


def write_take(folder, names):
    masks = sorted({name.partition(".")[0] for name in names})
    index = np.array([masks.index(name.partition(".")[0]) for name in names], np.int32)
    none = np.zeros(0, np.int32)
    deltas = local_shapes.gather(np.ones((len(names), 2, 3)))
    arrays = np.zeros((2, 3)), deltas, np.full((len(masks), 2), 0.5), index
    arrays += none, none, np.zeros((0, 3)), np.zeros(3)
    rig.write(folder / "rig.npz", rig.Rig(list(names), masks, [], *arrays, "cm", "y", 6.5))
    curves = np.random.default_rng(5).normal(size=(len(names), FRAMES)).astype(np.float32)
    turns, rest = np.tile([0.0, 0, 0, 1], (FRAMES, 1)), np.tile([0.0, 0, 0, 1], (FRAMES, 1))
    columns = dict(zip(names, curves, strict=True)) | weights.head_columns(turns, rest)
    columns |= {"confidence": np.ones(FRAMES)}
    paths = folder / "weights.parquet", folder / "weights.csv"
    weights.write(*paths, np.arange(FIRST, FIRST + FRAMES), columns, RATE)
    return dict(zip(names, curves, strict=True))


def export(folder):
    options = {"rig": f"{folder}/rig.npz", "weights": f"{folder}/weights.parquet"}
    options |= {layer: f"{folder}/{layer}.csv" for layer in ("emotion", "speech", "blink")}
    export_layers.main(words(options))


def read(path):
    with path.open(newline="") as stream:
        header, *rows = csv.reader(stream)
    return header, rows


def test_every_curve_stands_in_its_layer_to_the_last_bit(tmp_path):
    curves = write_take(tmp_path, COLUMNS)
    export(tmp_path)
    seen = set()
    for layer in ("emotion", "speech"):
        header, rows = read(tmp_path / f"{layer}.csv")
        assert header[:2] == ["frame", "time_s"]
        assert [int(row[0]) for row in rows] == list(range(FIRST, FIRST + FRAMES))
        for row in rows:
            assert float(row[1]) == pytest.approx(int(row[0]) / float(RATE), abs=1e-6)
        for column, name in enumerate(header[2:], start=2):
            mask, _, plain = name.partition(".")
            full = f"{mask}.{layer}_{plain}"
            found = np.array([row[column] for row in rows], np.float32)
            np.testing.assert_array_equal(found, curves[full])
            seen.add(full)
    assert seen == set(COLUMNS)


def test_a_layer_that_the_character_lacks_has_frames_and_no_curve(tmp_path):
    write_take(tmp_path, COLUMNS)
    export(tmp_path)
    header, rows = read(tmp_path / "blink.csv")
    assert (header, len(rows)) == (["frame", "time_s"], FRAMES)


def test_a_rig_without_layers_is_refused(tmp_path):
    write_take(tmp_path, ["face.jawOpen"])
    with pytest.raises(errors.InputError, match=r"rig\.npz: 'face\.jawOpen' is of no layer"):
        export(tmp_path)
    assert not (tmp_path / "emotion.csv").exists()
