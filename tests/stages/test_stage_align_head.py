from fractions import Fraction

import numpy as np
import pytest

from stages import align_head, merge_capture
from stages.core import clock
from stages.files import errors, series

RATE = Fraction(25)
NAMES = [f"{c}_{i:02d}" for c in ("eye_right", "eye_left", "brow", "lips") for i in range(6)]


def performance(path, points, confidence=None):
    frames = len(points)
    good = np.ones(frames) if confidence is None else confidence
    columns = series.unstack(points, NAMES) | {f"{n}.confidence": good for n in NAMES}
    columns |= {"confidence": good}
    times = clock.frame_times(frames, RATE)
    series.write(path, "performance", np.arange(frames), times, columns, RATE)
    return str(path)


@pytest.fixture
def take():
    """Draw a face [px, y down] whose lips move, and the head that carries it."""
    rng = np.random.default_rng(0)
    eyes = [[-30, 0], [30, 0]]
    centres = np.repeat(np.array([*eyes, [0, -30], [0, 60]]), 6, axis=0)
    neutral = centres + rng.normal(0, 8, (24, 2)) + [200, 150]
    face = np.repeat(neutral[None], 80, axis=0)
    face[1:, 18:, 1] += 10 * rng.random((79, 1))
    angle = 0.1 * np.sin(np.arange(80) / 9)
    c, s = np.cos(angle), np.sin(angle)
    turn = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], 1)
    shift = 6 * np.stack([np.sin(np.arange(80) / 5), np.cos(np.arange(80) / 7) - 1], -1)
    pixels = np.einsum("tij,tpj->tpi", turn, face - [200, 150]) + shift[:, None] + [200, 150]
    return neutral, face, pixels, angle


def run(tmp_path, path, head="remove", neutral_frame="0", unit_points="eye_right,eye_left"):
    outputs = [str(tmp_path / name) for name in ("head.parquet", "expression.parquet")]
    command = ["--performance", path, "--neutral", path, "--neutral-frame", neutral_frame]
    command += ["--unit-points", unit_points, "--head", head, "--seed", "1"]
    align_head.main([*command, "--head-motion", outputs[0], "--expression", outputs[1]])
    return series.read(outputs[0], "head_motion"), series.read(outputs[1], "expression")


def test_head_and_face_are_told_apart_in_face_units_with_y_up(tmp_path, take):
    neutral, face, pixels, angle = take
    motion, expression = run(tmp_path, performance(tmp_path / "p.parquet", pixels))
    # a picture's clockwise is y-up's clockwise: the angle changes its sign
    found = 2 * np.arctan2(motion.columns["rotation.z"], motion.columns["rotation.w"])
    np.testing.assert_allclose(found, -angle, atol=0.01)
    ends = np.array([neutral[:6].mean(axis=0), neutral[6:12].mean(axis=0)])
    unit = np.linalg.norm(ends[1] - ends[0])
    true = (face - ends.mean(axis=0)) / unit * [1, -1]
    points = series.stack(expression, "expression", NAMES)
    np.testing.assert_allclose(points, true, atol=0.02)
    np.testing.assert_allclose(expression.meta["neutral"], true[0], atol=1e-6)
    first = {name: values[0] for name, values in motion.columns.items()}
    assert first["rotation.w"] == pytest.approx(1, abs=1e-6)
    assert first["scale"] == pytest.approx(1, abs=1e-4)


def test_a_head_mounted_camera_keeps_the_points(tmp_path, take):
    *_, pixels, _ = take
    motion, expression = run(tmp_path, performance(tmp_path / "p.parquet", pixels), head="none")
    assert set(motion.columns["scale"]) == {1.0}
    points = series.stack(expression, "expression", NAMES)
    size = np.linalg.norm(pixels[0, :6].mean(axis=0) - pixels[0, 6:12].mean(axis=0))
    moved = np.diff(pixels, axis=0) / size * [1, -1]
    np.testing.assert_allclose(np.diff(points, axis=0), moved, atol=1e-5)


def test_lost_frames_stay_lost_and_faults_are_named(tmp_path, take):
    *_, pixels, _ = take
    pixels = pixels.copy()
    pixels[9] = np.nan
    confidence = np.ones(80)
    confidence[9] = 0
    path = performance(tmp_path / "p.parquet", pixels, confidence)
    motion, expression = run(tmp_path, path)
    assert np.isnan(motion.columns["scale"][9]) and np.isnan(expression.columns["lips_00.x"][9])
    assert np.isfinite(np.delete(expression.columns["lips_00.x"], 9)).all()
    with pytest.raises(errors.InputError, match="not tracked on the neutral frame 9"):
        run(tmp_path, path, neutral_frame="9")
    with pytest.raises(errors.InputError, match="neutral frame 80 is beyond the last frame 79"):
        run(tmp_path, path, neutral_frame="80")
    with pytest.raises(errors.InputError, match="unit point nose is no point or contour"):
        run(tmp_path, path, unit_points="nose,eye_left")


def test_a_film_of_variable_rate_comes_onto_the_clock(tmp_path):
    times = np.sort(np.random.default_rng(1).permutation(200)[:90]) / 100.0
    times[0] = 0.0
    columns = {"a.x": 3 * times, "a.confidence": np.ones(90), "confidence": np.ones(90)}
    tracked, merged = (str(tmp_path / f"{name}.parquet") for name in ("tracked", "performance"))
    series.write(tracked, "tracked", np.arange(90), times, columns, RATE)
    merge_capture.main(["--tracked", tracked, "--performance", merged])
    found = series.read(merged, "performance")
    np.testing.assert_allclose(found.time_s, np.arange(len(found.frame)) / 25)
    np.testing.assert_allclose(
        found.columns["a.x"], np.minimum(3 * found.time_s, 3 * times[-1]), atol=1e-6
    )


def test_a_film_of_constant_rate_stays_as_it_is(tmp_path):
    values = np.random.default_rng(1).normal(size=50)
    columns = {"a.x": values, "confidence": np.ones(50)}
    times = np.round(np.arange(50) / 25, 4)
    tracked, merged = (str(tmp_path / f"{name}.parquet") for name in ("tracked", "performance"))
    series.write(tracked, "tracked", np.arange(50), times, columns, RATE)
    merge_capture.main(["--tracked", tracked, "--performance", merged])
    np.testing.assert_array_equal(
        series.read(merged, "performance").columns["a.x"], values.astype(np.float32)
    )
