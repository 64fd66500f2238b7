import numpy as np
import pytest

from bench import kalman, linear_dynamics


def drawn(seed, frames=900, noise=0.02):
    """Return curves of a linear system with two turning components, and the same without noise."""
    rng = np.random.default_rng(seed)
    transition = np.zeros((4, 4))
    for block, angle in ((0, 0.15), (2, 0.35)):
        turn = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        transition[block : block + 2, block : block + 2] = 0.995 * np.array(turn)
    loadings = np.random.default_rng(7).normal(size=(6, 4))
    state, clean = rng.normal(size=4), np.empty((frames, 6))
    for row in clean:
        state = transition @ state + 0.05 * rng.normal(size=4)
        row[:] = 0.3 + loadings @ state
    return clean + noise * rng.normal(size=clean.shape), clean


def test_gaps_of_a_linear_system_come_back_better_than_by_straight_lines():
    model = linear_dynamics.learn([drawn(0)[0], drawn(1)[0]])
    spoilt, clean = drawn(2)
    rows, gone = np.arange(900), np.zeros(900, bool)
    for first in range(50, 850, 60):
        gone[first : first + 10] = True
    straight = np.stack([np.interp(rows, rows[~gone], one[~gone]) for one in spoilt.T], axis=1)
    given = np.where(gone[:, None], np.nan, spoilt)
    made = linear_dynamics.fill(model, given)
    np.testing.assert_array_equal(made[~gone], spoilt[~gone])
    assert np.std((made - clean)[gone]) < 0.4 * np.std((straight - clean)[gone])


def test_noise_of_a_linear_system_is_taken_out():
    model = linear_dynamics.learn([drawn(0, noise=0.3)[0]])
    noisy, clean = drawn(1, noise=0.3)
    assert np.sqrt(model.noise).mean() == pytest.approx(0.3, rel=0.35)
    made = linear_dynamics.smooth(model, noisy)
    assert np.std(made - clean) < 0.7 * np.std(noisy - clean)


def test_the_smoother_is_the_mean_of_the_joint_gaussian():
    rng = np.random.default_rng(3)
    turn = np.array([[0.9, 0.3], [-0.3, 0.9]])
    loadings, noise = rng.normal(size=(3, 2)), np.array([0.1, 0.2, 0.3])
    system = kalman.System(turn, 0.1 * np.eye(2), loadings, noise)
    count = 12
    values = rng.normal(size=(count, 3))
    values[4:7], values[9, 1] = np.nan, np.nan
    spread = kalman._spread(system)
    covariance = np.zeros((2 * count, 2 * count))
    for first in range(count):
        here = spread
        for second in range(first, count):
            rows, columns = slice(2 * first, 2 * first + 2), slice(2 * second, 2 * second + 2)
            covariance[columns, rows] = here
            covariance[rows, columns] = here.T
            here = turn @ here
        spread = turn @ spread @ turn.T + 0.1 * np.eye(2)
    shown = np.kron(np.eye(count), loadings)
    seen = np.isfinite(values).ravel()
    joint = shown @ covariance @ shown.T + np.diag(np.tile(noise, count))
    weights = np.linalg.solve(joint[np.ix_(seen, seen)], (shown @ covariance)[seen])
    expected = (values.ravel()[seen] @ weights).reshape(count, 2)
    made = kalman.smooth(system, values)
    np.testing.assert_allclose(made.mean, expected, atol=1e-9)
    left = covariance - (shown @ covariance)[seen].T @ weights
    for frame, own in enumerate(made.covariance):
        block = slice(2 * frame, 2 * frame + 2)
        np.testing.assert_allclose(own, left[block, block], atol=1e-9)


def test_what_shows_no_motion_is_refused():
    with pytest.raises(ValueError, match="no motion"):
        linear_dynamics.learn([np.zeros((20, 3))])
    with pytest.raises(ValueError, match="do not belong together"):
        linear_dynamics.learn([np.zeros((20, 3)), np.zeros((20, 4))])
