"""Dynamics from basis takes to weights: gaps filled, jitter out, what does not fit refused."""

from fractions import Fraction

import numpy as np
import pytest
from small_take import SmallTake, words

from stages import assemble_rig, learn_dynamics, smooth_weights
from stages.files import dynamics, errors, rig, series, weights

RATE = Fraction(30)
FRAMES = 700


@pytest.fixture(scope="module")
def take(tmp_path_factory):
    made = SmallTake(tmp_path_factory.mktemp("dynamics"))
    assemble_rig.main(made.rig_options())
    made.names = rig.read_any(made.folder / "rig.npz").names
    for number in range(2):
        write(made, f"basis{number}", performed(len(made.names), number))
    learn(made, "basis0", "basis1")
    return made


def performed(shapes, seed):
    """Return weights (FRAMES, K) that rest and move in turn, two things at once."""
    rng = np.random.default_rng(seed)
    mixing = np.abs(np.random.default_rng(5).normal(0.3, 0.1, (2, shapes)))
    made, at, pose = np.zeros((FRAMES, 2)), 0, np.zeros(2)
    while at < FRAMES:
        hold, move = rng.integers(5, 20), rng.integers(8, 20)
        target = rng.uniform(0, 1, 2)
        ease = (1 - np.cos(np.pi * np.arange(1, move + 1) / (move + 1))) / 2
        made[at : at + hold] = pose
        here = made[at + hold : at + hold + move]
        here[:] = (pose + ease[:, None] * (target - pose))[: len(here)]
        at, pose = at + hold + move, target
    return made @ mixing


def write(take, name, values, kind="predicted", confidence=None):
    frames = np.arange(len(values))
    columns = dict(zip(take.names, values.T, strict=True))
    columns["confidence"] = np.full(len(values), 0.9) if confidence is None else confidence
    path = take.folder / f"{name}.parquet"
    series.write(path, kind, frames, frames / float(RATE), columns, RATE)


def learn(take, *names, rig_name="rig.npz"):
    files = [f"{take.folder}/{name}.parquet" for name in names]
    options = {"rig": f"{take.folder}/{rig_name}", "dynamics": f"{take.folder}/dynamics.npz"}
    learn_dynamics.main([*words(options), "--solutions", *files])


def smoothed(take, name, *more, **options):
    given = {"solution": f"{name}.parquet", "head": "none"} | options
    path = f"--dynamics={take.folder}/dynamics.npz"
    smooth_weights.main([*take.weights_options(**given), path, *more])
    return weights.read(take.folder / "weights.parquet", take.names)


FILLED = "--gap-filling=dynamics"


def test_gaps_are_filled_better_than_by_straight_lines(take):
    truth = performed(len(take.names), 7)
    spoilt = truth.copy()
    for first in range(40, 640, 60):
        spoilt[first : first + 8] = np.nan
    # where a confidence is 0 the solver has only held what was before
    held, confidence = spoilt.copy(), np.full(FRAMES, 0.9)
    held[20:30], confidence[20:30] = held[19], 0.0
    write(take, "spoilt", held, confidence=confidence)
    made = smoothed(take, "spoilt", FILLED)
    straight = smoothed(take, "spoilt")
    lost = np.isnan(spoilt).any(axis=1)
    np.testing.assert_array_equal(made.confidence == 0, lost | (confidence == 0))
    seen = ~lost & (confidence > 0)
    np.testing.assert_array_equal(made.shapes[seen], truth.astype(np.float32)[seen])
    assert np.std((made.shapes - truth)[lost]) < 0.7 * np.std((straight.shapes - truth)[lost])
    assert np.abs(made.shapes - truth)[20:30].max() < np.abs(straight.shapes - truth)[20:30].max()
    assert made.shapes.min() >= 0
    assert made.shapes.max() <= 1


def test_a_region_that_is_lost_follows_the_others(take):
    truth = performed(len(take.names), 8)
    spoilt = truth.copy()
    spoilt[100:160, :2] = np.nan
    write(take, "part", spoilt)
    made = smoothed(take, "part", FILLED)
    assert np.abs(made.shapes - truth)[100:160, :2].max() < 0.05
    np.testing.assert_array_equal(made.shapes[:, 2:], truth.astype(np.float32)[:, 2:])


def test_layers_stay_parts_of_their_masks(take):
    truth = performed(len(take.names), 9)
    spoilt = truth.copy()
    spoilt[200:230] = np.nan
    write(take, "layers", spoilt, "directed")
    made = smoothed(take, "layers", FILLED, smoothing="dynamics")
    index = rig.read_any(take.folder / "rig.npz").mask_index
    for mask in np.unique(index):
        sums = made.shapes[:, index == mask].sum(axis=1)
        assert sums.max() <= np.nansum(spoilt[:, index == mask], axis=1).max() + 1e-6
    assert made.shapes.min() >= 0


def test_jitter_is_taken_out(take):
    truth = performed(len(take.names), 10)
    noise = 0.01 * np.random.default_rng(0).standard_normal(truth.shape)
    write(take, "noisy", truth + noise, "key_weights")
    made = smoothed(take, "noisy", smoothing="dynamics")
    usual = smoothed(take, "noisy", smoothing="multiresolution")
    still = [name for name in take.names if not name.startswith("mouth")]
    columns = [take.names.index(name) for name in still]
    left = [np.std((one.shapes - truth)[:, columns]) for one in (made, usual)]
    assert left[0] < 0.8 * 0.01
    assert left[0] < left[1]


def test_the_same_takes_give_the_same_bytes(take):
    before = (take.folder / "dynamics.npz").read_bytes()
    learn(take, "basis0", "basis1")
    assert (take.folder / "dynamics.npz").read_bytes() == before
    read = dynamics.read(take.folder / "dynamics.npz", take.names, "rig.npz")
    assert read.motion.deviations.shape[1] == len(take.names)


def test_a_take_without_one_of_the_shapes_is_left_out(take):
    values = performed(len(take.names), 3)
    values[:, 1] = np.nan
    write(take, "blind", values)
    before = (take.folder / "dynamics.npz").read_bytes()
    learn(take, "basis0", "blind", "basis1")
    assert (take.folder / "dynamics.npz").read_bytes() == before
    with pytest.raises(errors.InputError, match=r"blind.parquet: in no basis take is every shape"):
        learn(take, "blind")


def test_what_does_not_fit_is_refused(take):
    write(take, "short", performed(len(take.names), 3)[:20])
    with pytest.raises(errors.InputError, match="too few stretches to learn: mark longer shots"):
        learn(take, "short")
    with pytest.raises(errors.InputError, match="--dynamics: is needed"):
        given = {"solution": "basis0.parquet", "head": "none", "smoothing": "dynamics"}
        smooth_weights.main(take.weights_options(**given))
    with pytest.raises(errors.InputError, match="was learnt for .* shapes"):
        dynamics.read(take.folder / "dynamics.npz", take.names[1:], "rig.npz")
    values = performed(len(take.names), 3)
    values[:, 1] = np.nan
    write(take, "blind", values)
    with pytest.raises(errors.InputError, match=f"{take.names[1]} is nowhere tracked"):
        smoothed(take, "blind", FILLED)
    with pytest.raises(errors.InputError, match="kind 'weights'"):
        learn(take, "weights")
