from fractions import Fraction

import numpy as np
import pytest
import scipy.spatial.transform
from small_take import FRAMES, RATE, SmallTake

from stages import assemble_rig, smooth_weights
from stages.files import errors, rig, series, weights

FAST = Fraction(120)
SECONDS = 4


@pytest.fixture
def take(tmp_path):
    made = SmallTake(tmp_path)
    assemble_rig.main(made.rig_options())
    return made


def smoothed(take, **options):
    smooth_weights.main(take.weights_options(**options))
    names = rig.read_any(take.folder / "rig.npz").names
    return names, weights.read(take.folder / "weights.parquet", names)


def drawn(take, kind, rate=FAST, size=0.0, **curves):
    """Write a solution of one kind, 0.5 everywhere but for the given shapes, with jitter."""
    names = rig.read_any(take.folder / "rig.npz").names
    frames = np.arange(int(SECONDS * rate))
    rng = np.random.default_rng(0)
    columns = {name: 0.5 + size * rng.standard_normal(len(frames)) for name in names}
    columns |= {name.replace("__", "."): columns[names[0]] - 0.5 + c for name, c in curves.items()}
    columns["confidence"] = np.full(len(frames), 0.9)
    path = take.folder / f"{kind}.parquet"
    series.write(path, kind, frames, frames / float(rate), columns, rate)
    return {"solution": f"{kind}.parquet", "head": "none"}


def table(take, text):
    path = take.folder / "channels.tsv"
    path.write_text(text.replace(",", "\t"))
    return str(path)


def expressed(take, rate=FAST, frames=None):
    """Write an expression with lips that close at two seconds."""
    frames = np.arange(int(SECONDS * rate)) if frames is None else frames
    time = frames / float(rate)
    gap = 0.02 + 0.3 * np.clip(np.abs(time - 2.0) / 0.06, 0, 1)
    columns = {"upper.x": 0 * time, "upper.y": gap, "lower.x": 0 * time, "lower.y": 0 * time}
    columns |= {"tip.x": 0 * time, "tip.y": gap, "tip.z": gap, "confidence": 1 + 0 * time}
    series.write(take.folder / "expression.parquet", "expression", frames, time, columns, rate)
    return gap


def test_at_the_films_rate_nothing_changes(take):
    names, read = smoothed(take)
    expected = np.stack([take.weights[name] for name in names], axis=1).astype(np.float32)
    np.testing.assert_array_equal(read.shapes, expected)
    np.testing.assert_array_equal(read.translation, take.shift.astype(np.float32))
    np.testing.assert_allclose(read.rotation, take.turns, atol=1e-7)
    assert read.rate == RATE


def test_another_rate_interpolates_exactly(take):
    names, read = smoothed(take, rate="24000/1001")
    assert read.rate == Fraction(24000, 1001)
    times = read.frame * 1001 / 24000
    assert times[-1] <= (FRAMES - 1) / 30 < times[-1] + 1001 / 24000
    for column, name in enumerate(names):
        expected = np.interp(times, np.arange(FRAMES) / 30, take.weights[name])
        np.testing.assert_allclose(read.shapes[:, column], expected, atol=1e-6)
    rotations = scipy.spatial.transform.Rotation.from_quat(take.turns)
    expected = scipy.spatial.transform.Slerp(np.arange(FRAMES) / 30, rotations)(times)
    apart = scipy.spatial.transform.Rotation.from_quat(read.rotation) * expected.inv()
    assert apart.magnitude().max() < 1e-5


def test_untracked_frames_are_spanned_and_marked(take):
    lost = np.isin(np.arange(FRAMES), [0, 7, 8])
    for name in take.weights:
        take.weights[name] = np.where(lost, np.nan, np.arange(FRAMES, dtype=float))
    take.turns[lost] = np.nan
    take.turns[9:] *= -1
    take.write_weights()
    take.write_head()
    _, read = smoothed(take)
    np.testing.assert_allclose(read.shapes[:, 0], [1, *range(1, FRAMES)], atol=1e-6)
    np.testing.assert_array_equal(read.confidence == 0, lost)
    assert (np.sum(read.rotation[1:] * read.rotation[:-1], axis=1) > 0).all()
    _, slower = smoothed(take, rate="25")
    touched = [frame for frame in slower.frame if 6 < frame * 30 / 25 < 9 or frame == 0]
    np.testing.assert_array_equal(slower.frame[slower.confidence == 0], touched)


def test_head_motion_can_be_left_out(take):
    _, read = smoothed(take, head="none")
    np.testing.assert_array_equal(read.rotation, np.tile([0, 0, 0, 1], (FRAMES, 1)))
    np.testing.assert_array_equal(read.translation, 0)
    np.testing.assert_array_equal(read.scale, 1)


def test_bad_input_is_named(take):
    for rate in ("fast", "0", "1/0"):
        with pytest.raises(errors.InputError, match=r"is no rate such as 30 or 30000/1001"):
            smoothed(take, rate=rate)
    first = next(iter(take.weights))
    take.write_weights(**{first: np.full(FRAMES, np.nan)})
    with pytest.raises(errors.InputError, match=r"key_weights\.parquet: no frame was tracked"):
        smoothed(take)
    del take.weights[first]
    take.write_weights()
    with pytest.raises(errors.InputError, match=rf"column {first}, which the rig needs"):
        smoothed(take)
    path = take.folder / "head_motion.parquet"
    with pytest.raises(errors.InputError, match="kind 'head_motion', expected 'key_weights' or"):
        smoothed(take, solution=path.name)
    with pytest.raises(errors.InputError, match="channels.tsv: line 2, column shape: the rig has"):
        smoothed(take, channels=table(take, "shape\nrom_f9999\n"), **drawn(take, "solved"))


@pytest.mark.parametrize("kind", ["key_weights", "predicted", "solved"])
@pytest.mark.parametrize("smoothing", ["none", "multiresolution"])
def test_every_method_has_its_limits(take, kind, smoothing):
    over = {"mouth__rom_f0003": np.full(480, 1.7), "eyes__rom_f0011": np.full(480, -0.4)}
    names, read = smoothed(take, smoothing=smoothing, **drawn(take, kind, **over))
    limits = (-np.inf, np.inf) if kind == "key_weights" else (0, 1)
    expected = np.full(read.shapes.shape, 0.5)
    expected[:, names.index("mouth.rom_f0003")] = np.clip(1.7, *limits)
    expected[:, names.index("eyes.rom_f0011")] = np.clip(-0.4, *limits)
    np.testing.assert_allclose(read.shapes, expected, rtol=0, atol=1e-7)
    np.testing.assert_array_equal(read.confidence, np.float32(0.9))


def test_gains_and_offsets_come_before_limits(take):
    text = "shape,gain,offset,low,high\nmouth.rom_f0003,3,-1,,1.25\nrom_f0011,-1,,-0.25,\n"
    text += "rom_f0012,0.5,,,0.4\n"
    ramp = np.linspace(-1, 2, 480)
    curves = {f"{n}": ramp for n in ("mouth__rom_f0003", "eyes__rom_f0011", "eyes__rom_f0012")}
    options = drawn(take, "solved", **curves)
    names, read = smoothed(take, channels=table(take, text), **options)
    for name, expected in (
        ("mouth.rom_f0003", np.clip(3 * ramp - 1, 0, 1.25)),
        ("eyes.rom_f0011", np.clip(-ramp, -0.25, 1)),
        ("eyes.rom_f0012", np.clip(0.5 * ramp, 0, 0.4)),
    ):
        np.testing.assert_allclose(read.shapes[:, names.index(name)], expected, atol=1e-6)


def test_a_table_that_asks_nothing_changes_nothing(take):
    options = drawn(take, "key_weights", size=0.3)
    _, without = smoothed(take, **options)
    _, with_table = smoothed(take, channels=table(take, "shape\nrom_f0003\n"), **options)
    np.testing.assert_array_equal(with_table.shapes, without.shapes)


def test_limits_hold_after_all_else(take):
    options = drawn(take, "solved", size=0.4) | {"rate": "24"}
    _, read = smoothed(take, smoothing="multiresolution", **options)
    assert read.shapes.min() >= 0
    assert read.shapes.max() <= 1


def test_jitter_goes_as_far_as_a_channel_asks(take):
    text = "shape,smoothing\nrom_f0003,0\nrom_f0040,0.5\nrom_f0041,2\n"
    options = drawn(take, "solved", size=0.05) | {"channels": table(take, text)}
    names, before = smoothed(take, **options)
    _, after = smoothed(take, smoothing="multiresolution", **options)
    left = {
        name: after.shapes[:, column].var() / before.shapes[:, column].var()
        for column, name in enumerate(names)
    }
    np.testing.assert_array_equal(after.shapes[:, 0], before.shapes[:, 0])
    assert left["mouth.rom_f0041"] < left["eyes.rom_f0011"] < left["mouth.rom_f0040"] < 0.6
    assert left["eyes.rom_f0011"] < 0.3


def test_marked_blinks_are_kept(take):
    time = np.arange(480) / 120
    blink = 0.1 + 0.8 * np.clip(1 - np.abs(time - 2) / 0.08, 0, 1)
    curves = {"eyes__rom_f0011": blink, "eyes__rom_f0012": blink}
    options = drawn(take, "predicted", size=0.01, **curves)
    text = "shape,keep\nrom_f0011,blink\n"
    names, read = smoothed(
        take, channels=table(take, text), smoothing="multiresolution", rate="60", **options
    )
    marked, other = (read.shapes[120, names.index(f"eyes.rom_f00{n}")] for n in (11, 12))
    assert marked > 0.1 + 0.95 * 0.8 > other + 0.03


def test_lip_points_keep_closures(take):
    gap = expressed(take)
    names = [f"mouth__{name}" for name in ("rom_f0003", "rom_f0040", "rom_f0041")]
    options = drawn(take, "solved", size=0.002, **dict.fromkeys(names, 2 * gap))
    options |= {"smoothing": "multiresolution"}
    shapes, without = smoothed(take, **options)
    _, read = smoothed(take, lip_points="upper, lower", **options)
    for name in names:
        column = shapes.index(name.replace("__", "."))
        assert without.shapes[240, column] > 0.1
        assert read.shapes[240, column] < 0.06
    other = shapes.index("eyes.rom_f0011")
    np.testing.assert_array_equal(read.shapes[:, other], without.shapes[:, other])


def test_a_lower_rate_takes_no_aliases(take):
    wave = 0.5 + 0.4 * np.sin(2 * np.pi * 24.0 * np.arange(480) / 120)
    options = drawn(take, "solved", mouth__rom_f0003=wave) | {"rate": "25"}
    _, plain = smoothed(take, **options)
    _, filtered = smoothed(take, smoothing="multiresolution", **options)
    assert np.ptp(plain.shapes[10:-10, 0]) > 0.5
    assert np.ptp(filtered.shapes[10:-10, 0]) < 0.02


def test_bad_lip_points_are_named(take):
    expressed(take)
    options = drawn(take, "solved") | {"smoothing": "multiresolution"}
    for pair in ("upper", "upper,lower,tip", "upper,upper"):
        with pytest.raises(errors.InputError, match=f"--lip-points: '{pair}' is no pair"):
            smoothed(take, lip_points=pair, **options)
    with pytest.raises(errors.InputError, match="--lip-points: 'upper' is no pair"):
        smoothed(take, lip_points="upper,lower;upper", **options)
    for pair in ("upper,chin", "upper,tip", "upper,lower;upper,chin"):
        with pytest.raises(
            errors.InputError, match=r"expression\.parquet: has no two points upper"
        ):
            smoothed(take, lip_points=pair, **options)
    expressed(take, frames=np.arange(100))
    with pytest.raises(errors.InputError, match="its 100 frames are not the 480 of the solution"):
        smoothed(take, lip_points="upper,lower", **options)
