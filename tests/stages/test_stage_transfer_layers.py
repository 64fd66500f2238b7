import logging
from fractions import Fraction

import layered_actor
import numpy as np
import pytest

from stages import transfer_layers_published
from stages.core import layer_composition
from stages.files import errors, layers, series, simplices


@pytest.fixture
def actor(tmp_path):
    return layered_actor.LayeredActor(tmp_path)


def composed(made, found):
    """Return the offsets (T, D) that the layers of a file show."""
    u = layer_composition.displacements(
        made.layer, found.weights, found.coefficients, found.amplitudes
    )
    return layer_composition.composed(made.basis, made.mask_weights, u)


@pytest.mark.parametrize("points", ["both", "markers"])
@pytest.mark.parametrize("balance", ["mask_variance", "variance", "published"])
def test_planted_layers_come_back(actor, points, balance):
    actor.assemble(points=points, balance=balance)
    found = layers.read(actor.transfer())
    np.testing.assert_allclose(found.weights, actor.weights, atol=1e-3)
    np.testing.assert_allclose(found.coefficients, actor.coefficients, atol=1e-3)
    np.testing.assert_array_equal(found.amplitudes, 1)
    assert found.measures["residual"].max() < 1e-5
    assert found.measures["gap"].max() < 1e-6 and found.measures["gap"].min() > -1e-6
    # of 72 coordinates of markers and 36 of points of the film
    wanted = 0.8 if points == "markers" else (72 * 0.8 + 36 * 0.9) / 108
    np.testing.assert_allclose(found.confidence, wanted, rtol=1e-6)
    assert (found.rate, found.layers) == (layered_actor.RATE, layered_actor.LAYERS)


def test_the_film_alone_shows_the_same_face(actor):
    """Coefficients are not all settled by few points: what they compose is."""
    made = simplices.read(actor.assemble(points="video"))
    found = layers.read(actor.transfer())
    wanted = actor.offsets["play"][:, actor.sizes[0] :]
    np.testing.assert_allclose(composed(made, found), wanted, atol=2e-3)
    np.testing.assert_allclose(found.confidence, 0.9, rtol=1e-6)


def test_all_a_hundred_times_as_large_is_the_same(actor):
    actor.assemble()
    first = layers.read(actor.transfer(temporal=0.05, lip_sigma=0.05))
    actor.offsets = {shot: 100 * offsets for shot, offsets in actor.offsets.items()}
    actor.neutrals = tuple(100 * neutral for neutral in actor.neutrals)
    actor.write()
    actor.assemble()
    second = layers.read(actor.transfer(temporal=0.05, lip_sigma=5))
    np.testing.assert_allclose(second.weights, first.weights, atol=1e-3)
    np.testing.assert_allclose(second.coefficients, first.coefficients, atol=1e-3)
    np.testing.assert_allclose(
        second.measures["objective"], first.measures["objective"], rtol=1e-4, atol=1e-5
    )


def test_closing_lips_draw_the_mouth_to_m(actor):
    made = simplices.read(actor.assemble())
    lips = slice(actor.sizes[0] + 12, actor.sizes[0] + 16)
    upper, lower = actor.neutrals[1][6], actor.neutrals[1][7]
    apart = (upper - lower) / np.linalg.norm(upper - lower)
    wide = np.full(len(actor.offsets["play"]), made.closed_gap + 1.0)
    wide[10:20] = made.closed_gap
    wide[30], wide[35] = np.nan, made.closed_gap + 0.02
    actor.offsets["play"][:, lips] = np.concatenate(
        [(wide[:, None] * apart + lower) - upper, 0 * wide[:, None] * apart], axis=1
    )
    actor.write()
    found = layers.read(actor.transfer(lip_sigma=0.02))
    closed = np.zeros(len(wide))
    closed[10:20], closed[35] = 1, np.exp(-0.5)
    np.testing.assert_allclose(found.measures["lip_bias"], closed, atol=1e-3)
    speech = found.layers.index("speech")
    shown = closed == 1
    assert found.weights[shown, 1, speech].min() > 0.95
    assert found.coefficients[shown, found.extremes.index(("speech", "m"))].min() > 0.95
    mouth = layers.read(actor.transfer(lip_sigma=0.02, lip_bias="mouth"))
    assert mouth.weights[shown, 1, speech].min() > 0.95
    elsewhere = actor.mask != 1
    errors_of = [
        np.linalg.norm((composed(made, each) - actor.offsets["play"])[shown][:, elsewhere])
        for each in (mouth, found)
    ]
    assert errors_of[0] < 0.6 * errors_of[1]
    kept = layers.read(actor.transfer(lip_sigma=0.02, lip_bias="gap"))
    closed[35] = 0.5
    np.testing.assert_allclose(kept.measures["lip_bias"], closed, atol=1e-3)
    free = layers.read(actor.transfer(lip_sigma=0))
    np.testing.assert_array_equal(free.measures["lip_bias"], 0)
    assert free.weights[shown, 1, speech].min() < 0.9


def test_the_temporal_bias_means_the_same_at_every_rate(actor):
    """A step decays as fast at 120 as at 30 frames per second."""
    shares = {}
    for rate in (30, 120):
        steps = np.repeat([0.0, 1.0], [rate // 5, rate])[:, None]
        offsets = (1 - steps) * actor.basis[:, 0] + steps * actor.basis[:, 1]
        actor.write_expression(actor.folder / "step.parquet", offsets, Fraction(rate))
        actor.assemble()
        path = actor.transfer(expression=actor.folder / "step.parquet", temporal=0.5)
        found = layers.read(path)
        after = rate // 5 - 1 + np.arange(1, 6) * rate // 30
        shares[rate] = found.coefficients[after, 1]
    assert shares[30][0] < 0.9 < shares[30][-1]
    np.testing.assert_allclose(shares[120], shares[30], atol=0.08)


def test_frames_with_too_little_are_empty_and_others_use_what_there_is(actor):
    actor.assemble()
    actor.offsets["play"][5, 50:] = np.nan
    actor.offsets["play"][9, :9] = np.nan
    actor.write()
    found = layers.read(actor.transfer())
    lost = np.arange(len(found.frame)) == 5
    for values in (found.weights, found.coefficients, found.amplitudes):
        np.testing.assert_array_equal(np.isnan(values).reshape(len(lost), -1).all(axis=1), lost)
        np.testing.assert_array_equal(np.isnan(values).reshape(len(lost), -1).any(axis=1), lost)
    for name in ("residual", "outside", "objective", "gap"):
        np.testing.assert_array_equal(np.isnan(found.measures[name]), lost)
    np.testing.assert_array_equal(found.confidence == 0, lost)
    np.testing.assert_allclose(found.weights[~lost], actor.weights[~lost], atol=2e-3)


def test_motion_beyond_the_extremes_is_followed_when_asked(actor):
    actor.assemble()
    actor.offsets["play"] = 1.3 * np.repeat(actor.basis[:, :5].T, 3, axis=0)
    actor.write()
    hard = layers.read(actor.transfer())
    soft = layers.read(actor.transfer(beyond=0.5))
    assert hard.measures["outside"].min() > 0.1
    assert np.all(soft.measures["residual"] < 0.6 * hard.measures["residual"])
    assert soft.amplitudes.min() > 1.1 and soft.amplitudes.max() <= 1.5
    np.testing.assert_array_equal(hard.amplitudes, 1)


def test_points_that_a_shot_lacks_are_missing(actor, caplog):
    actor.assemble()
    path = actor.folder / "play.parquet"
    whole = series.read(path, "expression")
    meta = whole.meta | {
        "markers": whole.meta["markers"][:-1],
        "marker_neutral": whole.meta["marker_neutral"][:-1],
    }
    columns = {n: v for n, v in whole.columns.items() if not n.startswith("E7.")}
    series.write(path, "expression", whole.frame, whole.time_s, columns, whole.rate, meta)
    with caplog.at_level(logging.INFO):
        found = layers.read(actor.transfer())
    assert "not used, the shot lacks them: E7" in caplog.text
    np.testing.assert_allclose(found.weights, actor.weights, atol=1e-3)


def test_bad_input_is_one_line(actor):
    actor.assemble(lip_sigma=0)
    for changed, message in (
        ({"lip_sigma": -1}, "--lip-sigma: is -1"),
        ({"temporal": "nan"}, "--temporal: is nan"),
        ({"temporal": "1e300"}, "--temporal: is 1e.300: give 0 to 1e.06"),
        ({"beyond": "inf"}, "--beyond: is inf"),
        ({"lip_sigma": 0.02}, "was made for lip points '' and lip mask '', not 'lips_00,lips_01'"),
        ({"simplices": actor.folder / "rig.npz"}, "kind 'rig', expected 'simplices'"),
    ):
        with pytest.raises(errors.InputError, match=message):
            actor.transfer(**changed)
    actor.write_expression(actor.folder / "play.parquet", actor.offsets["play"], kinds=["points"])
    with pytest.raises(errors.InputError, match="holds no markers points"):
        actor.transfer()


def test_the_same_input_gives_the_same_bytes(actor):
    actor.assemble()
    first = actor.transfer(temporal=0.05).read_bytes()
    assert actor.transfer(temporal=0.05).read_bytes() == first


def test_the_published_sequence_finds_the_planted_layers_too(tmp_path):
    actor = layered_actor.LayeredActor(tmp_path, frames=4)
    made = simplices.read(actor.assemble())
    path = actor.transfer(transfer_layers_published, seed=0)
    found = layers.read(path)
    np.testing.assert_allclose(composed(made, found), actor.offsets["play"], atol=0.02)
    assert np.isnan(found.measures["gap"]).all() and np.all(found.amplitudes == 1)
    assert series.read(path, "layers").meta["solver"] == "published"
    certified = layers.read(actor.transfer())
    assert np.all(certified.measures["objective"] <= found.measures["objective"] + 1e-6)
    with pytest.raises(errors.InputError, match=r"--beyond: is 0\.2: the published solver stays"):
        actor.transfer(transfer_layers_published, seed=0, beyond=0.2)
