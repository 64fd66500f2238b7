from fractions import Fraction

import numpy as np
import pytest

from stages import write_pairs
from stages.core import clock
from stages.files import channels, errors, pairs, reference_table, series

NAMES = ["face.jawOpen", "face.browInnerUp_L"]
RATE = Fraction(30)


def write_mapped(path, confidence):
    count = len(confidence)
    times = clock.frame_times(count, RATE)
    columns = {
        "face.jawOpen": 1.5 * times,
        "face.browInnerUp_L": 1 - times,
        "confidence": confidence,
    }
    series.write(path, "mapped", np.arange(count), times, columns, RATE)


def write_references(path, frames):
    blank = {"source": "extreme", "viseme": "", "emotion": "", "leverage": 0.0, "tuned_by": ""}
    rows = [blank | {"shot": s, "frame": f, "time_s": f / 120} for s, f in frames]
    reference_table.write(path, rows, {"pairs": 0, "uncovered": None})


def run(folder, shots=("a", "b")):
    words = ["--mapped", *(str(folder / f"{shot}.parquet") for shot in shots), "--shots", *shots]
    words += ["--references", str(folder / "references.parquet")]
    write_pairs.main([*words, "--channels", "", "--pairs", str(folder / "recorded.tsv")])


def test_curves_at_the_reference_frames_are_read_as_pairs(tmp_path):
    write_mapped(tmp_path / "a.parquet", np.ones(31))
    # frames on the markers' clock, four of them to one of the curves
    write_mapped(tmp_path / "b.parquet", np.where(np.arange(31) == 3, 0.0, 1.0))
    frames = [("a", 10), ("a", 40), ("a", 400), ("b", 12), ("b", 100), ("c", 5)]
    write_references(tmp_path / "references.parquet", frames)
    run(tmp_path)
    limits = channels.read("", NAMES, 0, 1)
    known = {"a": range(121), "b": range(121)}
    found = pairs.read([str(tmp_path / "recorded.tsv")], known, [], limits)
    assert [(one.animator, one.shot, one.frame) for one in found] == [
        ("recorded", "a", 10),
        ("recorded", "a", 40),
        ("recorded", "b", 100),
    ]
    for one in found:
        time = one.frame / 120
        np.testing.assert_allclose(one.weights, [min(1.5 * time, 1), 1 - time], atol=1e-5)


def test_nothing_in_common_is_refused(tmp_path):
    write_mapped(tmp_path / "a.parquet", np.ones(5))
    write_references(tmp_path / "references.parquet", [("z", 1)])
    with pytest.raises(errors.InputError, match=r"references\.parquet: no frame to tune lies"):
        run(tmp_path, ["a"])
