import itertools

import numpy as np
import pytest

from stages.core import contradictions


def key_shapes(seed, count=10, parameters=6):
    """Draw weights of key shapes, an actor, and a character that exaggerates other things."""
    rng = np.random.default_rng(seed)
    weights = rng.uniform(0, 1, (count, parameters)) * (rng.random((count, parameters)) < 0.5)
    weights[np.arange(count), np.arange(count) % parameters] = 1.0
    actor = rng.normal(size=(parameters, 24))
    character = rng.normal(size=(parameters, 300)) * rng.uniform(0.6, 1.6, (parameters, 1))
    return rng, weights, actor, character


def gram(shapes):
    return shapes @ shapes.T


@pytest.mark.parametrize("seed", range(12))
def test_sculpts_ten_percent_off_contradict_nothing(seed):
    rng, weights, actor, character = key_shapes(seed)
    sculpted = weights * (1 + 0.1 * rng.normal(size=weights.shape)) @ character
    source, target = gram(weights @ actor), gram(sculpted)
    assert contradictions.exchanged_pairs(source, target) == []
    assert contradictions.reversed_extremes(source, target) == []


@pytest.mark.parametrize("seed", range(12))
def test_two_exchanged_sculpts_are_named_and_no_others(seed):
    rng, weights, actor, character = key_shapes(seed)
    sculpted = weights * (1 + 0.1 * rng.normal(size=weights.shape)) @ character
    source = weights @ actor
    apart = {
        pair: np.linalg.norm(source[pair[0]] - source[pair[1]])
        for pair in itertools.combinations(range(len(source)), 2)
    }
    first, second = max(apart, key=apart.get)
    sculpted[[first, second]] = sculpted[[second, first]]
    assert contradictions.exchanged_pairs(gram(source), gram(sculpted)) == [(first, second)]


def test_a_wider_mouth_that_was_sculpted_narrower_is_named():
    _, weights, actor, character = key_shapes(3)
    weights = np.concatenate([weights, [2 * weights[0]]])
    sculpted = weights @ character
    sculpted[-1] *= 0.3
    source, target = gram(weights @ actor), gram(sculpted)
    assert contradictions.reversed_extremes(source, target) == [(len(weights) - 1, 0)]
    assert contradictions.reversed_extremes(source, gram(weights @ character)) == []


def test_units_do_not_matter_and_few_shapes_are_no_trouble():
    _, weights, actor, character = key_shapes(1)
    source, target = gram(weights @ actor), gram(weights[::-1] @ character)
    small = contradictions.exchanged_pairs(source, target)
    assert small == contradictions.exchanged_pairs(source, 1e6 * target)
    for count in (1, 2):
        part = np.ix_(range(count), range(count))
        assert contradictions.exchanged_pairs(source[part], target[part]) == []


def test_controls_in_degrees_and_shares_are_measured_by_their_ranges():
    misled = 0
    for seed in range(12):
        rng, weights, actor, _ = key_shapes(seed)
        units = np.array([40.0, 25.0, 1.0, 0.1, 1.0, 0.5])
        poses = weights * (1 + 0.1 * rng.normal(size=weights.shape)) * units
        source = gram(weights @ actor)
        misled += bool(contradictions.exchanged_pairs(source, gram(poses)))
        fair = gram(contradictions.by_range(poses))
        assert contradictions.exchanged_pairs(source, fair) == []
        assert contradictions.reversed_extremes(source, fair) == []
    assert misled > 0
