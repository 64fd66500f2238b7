import logging
from fractions import Fraction

import numpy as np
import pytest
import recorded_curves
from recorded_curves import CANONICAL, SHAPES

from stages import map_curves
from stages.core import clock, local_shapes
from stages.files import errors, rig, series

RATE = Fraction(60000, 1001)


def write_rig(path, shapes):
    rng = np.random.default_rng(0)
    made = rig.Rig(
        names=[f"face.{name}" for name in shapes],
        mask_names=["face"],
        controls=[],
        neutral=rng.normal(size=(8, 3)),
        deltas=local_shapes.gather(rng.normal(size=(len(shapes), 8, 3))),
        masks=np.ones((1, 8)),
        mask_index=np.zeros(len(shapes), np.int32),
        sizes=np.array([4, 4], np.int32),
        corners=np.arange(8, dtype=np.int32),
        colours=np.zeros((0, 3)),
        pivot=np.zeros(3),
        unit="cm",
        up_axis="y",
        face_unit=6.0,
    )
    rig.write(path, made)


def run(folder, shapes, curves=None):
    values = np.random.default_rng(1).uniform(0, 1, (20, 52))
    curves = dict(zip(CANONICAL, values.T, strict=True)) if curves is None else curves
    columns = curves | {"confidence": np.linspace(0, 1, 20)}
    meta = {"start_timecode": "10:00:00:00"}
    times = clock.frame_times(20, RATE)
    series.write(folder / "curves.parquet", "curves", np.arange(20), times, columns, RATE, meta)
    write_rig(folder / "rig.npz", shapes)
    words = ["--curves", str(folder / "curves.parquet"), "--rig", str(folder / "rig.npz")]
    words += ["--names", str(recorded_curves.NAMES_TABLE)]
    map_curves.main([*words, "--mapped", str(folder / "mapped.parquet")])
    return curves, series.read(folder / "mapped.parquet", "mapped")


@pytest.mark.parametrize("package", ["arkit", "mediapipe", "ict", "livelink", "unreal"])
def test_a_rig_in_any_spelling_is_driven(tmp_path, package):
    owners = {part: shape.name for shape in SHAPES for part in shape.spellings[package]}
    curves, mapped = run(tmp_path, sorted(owners))
    assert list(mapped.columns) == [*(f"face.{name}" for name in sorted(owners)), "confidence"]
    for part, owner in owners.items():
        np.testing.assert_allclose(mapped.columns[f"face.{part}"], curves[owner], atol=1e-6)
    np.testing.assert_allclose(mapped.columns["confidence"], np.linspace(0, 1, 20), atol=1e-6)
    assert mapped.rate == RATE and mapped.time_s[-1] == float(19 / RATE)
    assert mapped.meta["start_timecode"] == "10:00:00:00"


def test_shared_shapes_take_the_mean_and_unknown_ones_rest(tmp_path, caplog):
    with caplog.at_level(logging.INFO, logger="keyface"):
        curves, mapped = run(tmp_path, ["lookUp", "jawOpen", "earWiggle"])
    both = (curves["eyeLookUpLeft"] + curves["eyeLookUpRight"]) / 2
    np.testing.assert_allclose(mapped.columns["face.lookUp"], both, atol=1e-6)
    assert (mapped.columns["face.earWiggle"] == 0).all()
    assert "no channel drives: earWiggle" in caplog.text
    assert "has no mouthFunnel, which moves by" in caplog.text


def test_what_is_lost_is_said_in_shares_of_the_motion(tmp_path, caplog):
    wave = np.sin(np.arange(20))
    curves = {name: np.zeros(20) for name in CANONICAL}
    curves |= {"jawOpen": 0.3 * wave, "tongueOut": 0.1 * wave}
    with caplog.at_level(logging.INFO, logger="keyface"):
        run(tmp_path, ["jawOpen"], curves)
    assert "1 of 2 moving channels drive the rig, 10.0 % of the motion's variance" in caplog.text


def test_a_rig_of_unknown_names_is_refused(tmp_path):
    with pytest.raises(errors.InputError, match=r"rig\.npz: no shape of the rig has a known name"):
        run(tmp_path, ["a", "b"])
