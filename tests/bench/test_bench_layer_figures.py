"""The numbers behind the figures of layers: errors, outputs, weighted masks, frames, cuts."""

import dataclasses
from fractions import Fraction

import numpy as np
import pytest

from bench.figures import (
    layer_error_figure,
    layer_errors,
    layer_mask_figure,
    layer_pictures,
    layer_take,
    layer_timeline_figure,
)
from stages.core import layer_composition, local_shapes
from stages.files import layer_points, layers, rig, simplices

FRAMES, RATE = 300, 60
NAMES = ["emotion", "speech", "blink"]
MASKS = ["upper", "mouth", "eyes"]
LAYER = np.repeat([0, 1, 2], [4, 3, 2])
LAYOUT = [
    layer_points.Group("markers", [f"m{index}" for index in range(12)]),
    layer_points.Group("video", [f"v{index}" for index in range(9)]),
]
SIZE = 3 * 12 + 2 * 9


@pytest.fixture
def rng():
    """Return a seeded generator."""
    return np.random.default_rng(11)


@pytest.fixture
def made(rng):
    """Return simplices of drawn extremes, the first of each layer the neutral."""
    basis = rng.normal(size=(SIZE, len(LAYER)))
    basis[:, np.unique(LAYER, return_index=True)[1]] = 0.0
    owner = np.concatenate([np.repeat(np.arange(12) % 3, 3), np.repeat(np.arange(9) % 3, 2)])
    extremes = [(NAMES[j], f"e{k}") for k, j in enumerate(LAYER)]
    scale = rng.uniform(0.2, 2.0, SIZE)
    masks = np.eye(3)[owner].T
    given = (NAMES, extremes, MASKS, LAYOUT, "both", basis, scale, masks, LAYER)
    return simplices.Simplices(*given, "", "", np.nan, np.zeros(0), np.zeros(0), 0.0)


def solved_of(rng, made, count):
    """Return drawn layers of a take."""
    coefficients = np.zeros((count, len(LAYER)))
    for j in range(3):
        own = made.layer == j
        coefficients[:, own] = rng.dirichlet(np.ones(own.sum()), count)
    frame = np.arange(count)
    return layers.Layers(
        frame,
        frame / RATE,
        Fraction(RATE),
        MASKS,
        NAMES,
        made.extremes,
        rng.dirichlet(np.ones(3), (count, 3)),
        coefficients,
        np.ones((count, 3)),
        {},
        np.ones(count),
    )


@pytest.fixture
def take(rng, made):
    """Return a take of a character of twenty vertices."""
    names = [
        f"{mask}.{made.extremes[k][0]}_{made.extremes[k][1]}"
        for mask in MASKS
        for k in range(len(LAYER))
    ]
    neutral = rng.normal(size=(20, 3))
    deltas = np.tile(rng.normal(size=(len(LAYER), 20, 3)), (3, 1, 1))
    masks = rng.dirichlet(np.ones(3), 20).T
    index = np.repeat(np.arange(3), len(LAYER))
    none = np.zeros(0, int)
    character = rig.Rig(
        names, MASKS, [], neutral, local_shapes.gather(deltas), masks, index, none, none,
        np.zeros((0, 3)), np.zeros(3), "cm", "y", 1.0,
    )  # fmt: skip
    solved = solved_of(rng, made, FRAMES)
    u = layer_composition.displacements(
        LAYER, solved.weights, solved.coefficients, solved.amplitudes
    )
    return layer_take.LayerTake(solved, made, character, u.reshape(FRAMES, -1)), deltas


def test_a_frame_of_one_layer_is_rebuilt_by_that_layer_alone(rng, made):
    truth = solved_of(rng, made, 8)
    for j in range(3):
        frames = truth.coefficients[:, made.layer == j] @ made.basis[:, made.layer == j].T
        frames[3, 5] = np.nan
        rebuilt = [layer_errors.alone(made, frames, other) for other in range(3)]
        left = [np.sqrt(np.nanmean((frames - shape) ** 2)) for shape in rebuilt]
        assert left[j] < 1e-9
        assert min(left[other] for other in range(3) if other != j) > 0.1


def test_all_layers_rebuild_what_they_compose_and_are_never_behind_one(rng, made):
    frames = layer_errors.composed(made, solved_of(rng, made, 12))
    noisy = frames + 0.3 * rng.normal(size=frames.shape)
    for wanted in (frames, noisy):
        left = made.scale * (wanted - layer_errors.layered(made, wanted))
        for j in range(3):
            single = made.scale * (wanted - layer_errors.alone(made, wanted, j))
            assert ((left**2).sum(axis=1) <= (single**2).sum(axis=1) * (1 + 1e-9)).all()
    exact = made.scale * (frames - layer_errors.layered(made, frames))
    assert np.sqrt(np.mean(exact**2)) < 0.02 * np.sqrt(np.mean((made.scale * frames) ** 2))


def test_distance_is_the_root_mean_square_length_of_what_was_seen():
    wrong = np.array([[3.0, 4, 0, 0, 0, 0], [1, 2, 2, np.nan, 0, 0], [np.nan] * 6])
    found = layer_errors.distance(wrong, 3)
    np.testing.assert_allclose(found[:2], [5 / np.sqrt(2), 3.0])
    assert np.isnan(found[2])


def test_simplices_of_one_kind_keep_its_coordinates(made):
    markers, video = (layer_errors.of_kinds(made, [kind]) for kind in ("markers", "video"))
    np.testing.assert_array_equal(np.concatenate([markers.basis, video.basis]), made.basis)
    np.testing.assert_array_equal(np.concatenate([markers.scale, video.scale]), made.scale)
    assert [group.kind for group in video.layout] == ["video"]
    np.testing.assert_array_equal(
        layer_errors.of_kinds(made, ["markers", "video"]).basis, made.basis
    )


def test_the_order_is_by_the_means_of_the_published_ways_where_they_are_known():
    errors = {"layered": 1.0, "emotion": 3.0, "speech": 2.0, "blink": 4.0}
    curves = {way: np.array([mean - 0.5, mean + 0.5, np.nan]) for way, mean in errors.items()}
    curves[layer_errors.DELIVERED] = np.zeros(3)
    assert layer_error_figure.order(curves) == ["layered", "speech", "emotion", "blink"]


def test_outputs_are_masked_weighted_extremes_and_add_up(take, made):
    take, deltas = take
    frames = [4, 40]
    parts = [layer_take.outputs(take, frames, layer) for layer in NAMES]
    neutral = take.character.neutral
    whole = layer_take.outputs(take, frames)
    np.testing.assert_allclose(sum(parts) - 2 * neutral, whole, atol=1e-12)
    shares = layer_take.weighted_masks(take.solved.weights[frames], take.character.masks)
    np.testing.assert_allclose(shares.sum(axis=1), 1.0)
    for j, part in enumerate(parts):
        own = np.flatnonzero(made.layer == j)
        moved = np.einsum("tk,kvd->tvd", take.solved.coefficients[frames][:, own], deltas[own])
        np.testing.assert_allclose(part - neutral, shares[:, j, :, None] * moved, atol=1e-12)


def test_frames_are_pictures_apart_and_each_layer_has_its_number(take):
    take, _ = take
    calm = np.zeros(FRAMES)
    calm[90:120] = 1.0
    solved = dataclasses.replace(take.solved, confidence=1.0 - calm)
    shown = take.shown.copy()
    blink = [layer_take.layer_of(name) == "blink" for name in take.character.names]
    shown[200, blink] *= 50
    frames, strongest = layer_timeline_figure.chosen_frames(
        take._replace(solved=solved, shown=shown)
    )
    counts = {layer: strongest.count(layer) for layer in NAMES}
    assert counts == layer_timeline_figure.COUNTS
    assert frames == sorted(frames)
    assert all(frame % 2 == 0 and not calm[frame] for frame in frames)
    assert np.diff(frames).min() >= layer_timeline_figure.APART_S * RATE
    assert strongest[frames.index(200)] == "blink"


def test_a_weight_of_one_has_the_layers_colour():
    for layer in NAMES:
        none, full = layer_mask_figure.blended(np.array([0.0, 1.0]), layer)
        np.testing.assert_array_equal(none, layer_mask_figure.NONE)
        written = "#" + "".join(f"{round(255 * part):02X}" for part in full)
        assert written == layer_take.COLOURS[layer]


def test_the_stretch_is_even_and_of_pictures(take):
    frames = layer_mask_figure.stretch(take[0])
    assert len(frames) == layer_mask_figure.COUNT
    assert all(frame % 2 == 0 for frame in frames)
    assert np.ptp(np.diff(frames)) <= 2


@pytest.mark.parametrize(
    "low, high", [((40, 30), (60, 90)), ((0, 0), (20, 10)), ((5, 5), (99, 99))]
)
def test_a_window_holds_the_box_and_stays_in_the_picture(low, high):
    left, top, right, bottom = layer_pictures.window(low, high, 0.8, (120, 150))
    assert left >= 0
    assert top >= 0
    assert right <= 120
    assert bottom <= 150
    assert left <= low[0] < high[0] <= right
    assert top <= low[1] < high[1] <= bottom
    assert (right - left) / (bottom - top) == pytest.approx(0.8, abs=0.03)
