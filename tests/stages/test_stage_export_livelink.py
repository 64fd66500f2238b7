"""Live Link Face takes, read by the csv module and by the stage that imports the phone's."""

import csv
import logging
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from played_take import RATES
from recorded_curves import NAMES_TABLE
from scipy.spatial.transform import Rotation

from stages import export_livelink, import_curves
from stages.core import local_shapes
from stages.files import errors, live_link_writer, rig, series, weights

# as a phone writes it
ORDER = """EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft
EyeWideLeft EyeBlinkRight EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight
EyeSquintRight EyeWideRight JawForward JawRight JawLeft JawOpen MouthClose MouthFunnel MouthPucker
MouthRight MouthLeft MouthSmileLeft MouthSmileRight MouthFrownLeft MouthFrownRight MouthDimpleLeft
MouthDimpleRight MouthStretchLeft MouthStretchRight MouthRollLower MouthRollUpper MouthShrugLower
MouthShrugUpper MouthPressLeft MouthPressRight MouthLowerDownLeft MouthLowerDownRight
MouthUpperUpLeft MouthUpperUpRight BrowDownLeft BrowDownRight BrowInnerUp BrowOuterUpLeft
BrowOuterUpRight CheekPuff CheekSquintLeft CheekSquintRight NoseSneerLeft NoseSneerRight TongueOut
HeadYaw HeadPitch HeadRoll LeftEyeYaw LeftEyePitch LeftEyeRoll RightEyeYaw RightEyePitch
RightEyeRoll"""


def write_rig(folder, names):
    shapes = local_shapes.gather(np.ones((len(names), 1, 3)))
    made = rig.Rig(
        names=[f"face.{name}" for name in names],
        mask_names=["face"],
        controls=[],
        neutral=np.zeros((1, 3)),
        deltas=shapes,
        masks=np.ones((1, 1)),
        mask_index=np.zeros(len(names), int),
        sizes=np.zeros(0, np.int32),
        corners=np.zeros(0, np.int32),
        colours=np.zeros((0, 3)),
        pivot=np.zeros(3),
        unit="cm",
        up_axis="y",
        face_unit=6.0,
    )
    rig.write(folder / "rig.npz", made)


def played(folder, names, rate=Fraction(30), first=0, count=12, seed=0):
    """Write a rig and a take of it; return its weights and angles."""
    rng = np.random.default_rng(seed)
    values = rng.uniform(-0.1, 1.1, (count, len(names))).astype(np.float32)
    angles = rng.uniform(-0.5, 0.5, (count, 3))
    turns = Rotation.from_euler("YXZ", angles).as_quat()
    write_rig(folder, names)
    columns = {f"face.{name}": values[:, row] for row, name in enumerate(names)}
    columns |= weights.head_columns(turns, rng.uniform(0.9, 1.1, (count, 4)))
    columns |= {"confidence": np.ones(count)}
    paths = folder / "weights.parquet", folder / "weights.csv"
    weights.write(*paths, np.arange(first, first + count), columns, rate)
    return SimpleNamespace(values=values.astype(float), angles=angles)


def export(folder):
    words = ["--rig", f"{folder}/rig.npz", "--weights", f"{folder}/weights.parquet"]
    words += ["--names", str(NAMES_TABLE), "--livelink", f"{folder}/livelink.csv"]
    export_livelink.main(words)
    with (folder / "livelink.csv").open(newline="") as stream:
        header, *rows = csv.reader(stream)
    return header, rows


def test_columns_stand_in_the_phones_order(tmp_path, caplog):
    caplog.set_level(logging.INFO)
    take = played(tmp_path, ["jawLeft", "jawRight", "mouthLeft", "wobble", "browInnerUp"])
    header, rows = export(tmp_path)
    assert header == ["Timecode", "BlendShapeCount", *ORDER.split()]
    assert {row[1] for row in rows} == {"61"}
    table = {name: np.array([float(row[c]) for row in rows]) for c, name in enumerate(header) if c}
    for row, name in enumerate(["JawLeft", "JawRight", "MouthLeft"]):
        np.testing.assert_allclose(table[name], take.values[:, row], atol=1e-9)
    assert not table["EyeBlinkLeft"].any() and not table["LeftEyeYaw"].any()
    # yaw to the subject's right is positive, so is pitch downwards
    wanted = take.angles * [-1, 1, -1]
    found = np.stack([table[name] for name in ("HeadYaw", "HeadPitch", "HeadRoll")], axis=1)
    np.testing.assert_allclose(found, wanted, atol=1e-6)
    assert "0, because the rig lacks them: eyeBlinkLeft, " in caplog.text
    assert "leaves out: face.wobble" in caplog.text
    assert "shift and scale are left out" in caplog.text


def test_a_split_shape_is_the_mean_of_its_sides(tmp_path):
    take = played(tmp_path, ["browInnerUp_L", "browInnerUp_R", "jawOpen"])
    header, rows = export(tmp_path)
    found = [float(row[header.index("BrowInnerUp")]) for row in rows]
    np.testing.assert_allclose(found, take.values[:, :2].mean(axis=1), atol=1e-9)


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_the_import_of_phone_takes_reads_it_back_at_every_rate(tmp_path, rate):
    names = ["jawOpen", "eyeBlinkLeft", "mouthClose"]
    count = 3 * int(rate)
    take = played(tmp_path, names, rate, first=500, count=count)
    _, rows = export(tmp_path)
    words = ["--curve-file", f"{tmp_path}/livelink.csv", "--rate", "", "--names", str(NAMES_TABLE)]
    words += ["--curves", f"{tmp_path}/c.parquet", "--checks", f"{tmp_path}/checks.tsv"]
    import_curves.main([*words, "--head-motion", f"{tmp_path}/h.parquet"])
    read = series.read(tmp_path / "c.parquet", "curves")
    assert (read.rate, len(read.frame)) == (rate, count)
    found = np.stack([read.columns[name] for name in names], axis=1)
    np.testing.assert_allclose(found, take.values, atol=2e-6)
    assert read.meta["start_s"] == pytest.approx(500 / rate, abs=1e-5)
    motion = series.read(tmp_path / "h.parquet", "head_motion")
    turns = np.stack([motion.columns[f"rotation.{axis}"] for axis in "xyzw"], axis=1)
    between = Rotation.from_quat(turns) * Rotation.from_euler("YXZ", take.angles).inv()
    assert between.magnitude().max() < 1e-5
    whole, part = rows[-1][0].rsplit(":", 1)
    hours, minutes, seconds = map(int, whole.split(":"))
    last = 3600 * hours + 60 * minutes + seconds + float(part) / 60
    assert last == pytest.approx(float((500 + count - 1) / rate), abs=1 / 60_000)


@given(st.integers(0, 2 * 86_400 * 60_000))
def test_timecodes_are_sixtieths_and_begin_anew_at_midnight(ticks):
    text = live_link_writer.timecode(Fraction(ticks, 60_000))
    hours, minutes, seconds, part = text.split(":")
    assert [len(cell) for cell in (hours, minutes, seconds, part)] == [2, 2, 2, 6]
    assert int(hours) < 24 and int(minutes) < 60 and int(seconds) < 60 and float(part) < 60
    total = (int(hours) * 3600 + int(minutes) * 60 + int(seconds)) * 60_000
    assert total + round(float(part) * 1000) == ticks % (86_400 * 60_000)


def test_a_rig_of_other_names_is_refused(tmp_path):
    played(tmp_path, ["rom_f0003", "rom_f0040"])
    with pytest.raises(errors.InputError, match="none of its 2 shapes has a name that Live Link"):
        export(tmp_path)
    assert not (tmp_path / "livelink.csv").exists()
