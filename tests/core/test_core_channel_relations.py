import numpy as np

from stages.core import channel_relations


def drawn(noise, seed=0):
    """Return rows of four channels that two things move, and two that only noise moves."""
    rng = np.random.default_rng(seed)
    hidden = rng.normal(size=(600, 2))
    rows = np.concatenate([hidden @ rng.normal(size=(2, 4)), rng.normal(size=(600, 2))], axis=1)
    return rows + noise * rng.normal(size=rows.shape), np.repeat(np.arange(6), 100)


def test_related_channels_follow_and_others_do_not():
    rows, block = drawn(0.01)
    found = channel_relations.regression(rows, block, np.array([0, 1, 4]), np.array([2, 3, 5]))
    made = rows[:, [0, 1, 4]] @ found
    assert np.std(made[:, :2] - rows[:, 2:4]) < 0.05
    np.testing.assert_array_equal(found[:, 2], 0.0)


def test_what_holds_only_in_one_stretch_is_not_believed():
    rng = np.random.default_rng(1)
    rows, block = rng.normal(size=(600, 2)), np.repeat(np.arange(6), 100)
    rows[block == 2, 1] = rows[block == 2, 0]
    found = channel_relations.regression(rows, block, np.array([0]), np.array([1]))
    np.testing.assert_array_equal(found, 0.0)


def test_without_a_second_stretch_nothing_is_believed():
    rows, _ = drawn(0.0)
    found = channel_relations.regression(rows, np.zeros(600, int), np.array([0, 1]), np.array([2]))
    np.testing.assert_array_equal(found, 0.0)


def test_nothing_happens_where_nothing_moves():
    rows, block = np.zeros((60, 3)), np.repeat(np.arange(3), 20)
    found = channel_relations.regression(rows, block, np.array([0, 1]), np.array([2]))
    np.testing.assert_array_equal(found, 0.0)
