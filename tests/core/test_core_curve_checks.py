import numpy as np
import pytest

from stages.core import curve_checks, curve_mapping, quaternions

NAMES = ["jawOpen", "mouthClose", "mouthSmileLeft", *curve_checks.GAZE, *curve_checks.SIDEWAYS]
LIMITS = dict.fromkeys(NAMES, (0.0, 1.0))


def performance(seed=0):
    """Curves of a clean take, and the turns of its eyes."""
    rng = np.random.default_rng(seed)
    time = np.arange(400) / 30
    gaze, side = (np.sin(rng.uniform(1, 3) * time + rng.uniform(0, 6)) for _ in range(2))
    jaw = 0.5 + 0.5 * np.sin(2 * time)
    curves = {"jawOpen": jaw, "mouthClose": 0.6 * jaw, "mouthSmileLeft": np.sin(time) ** 2}
    for name, value in zip(curve_checks.GAZE, (gaze, -gaze, gaze, -gaze), strict=True):
        curves[name] = np.maximum(value, 0)
    for name, value in zip(curve_checks.SIDEWAYS, (side, -side, side, -side), strict=True):
        curves[name] = 0.3 * np.maximum(value, 0) + 0.01 * rng.random(400)
    # the left eye's inside is the subject's right, a negative turn about the y axis
    angles = {"eye_left": -0.5 * gaze, "eye_right": -0.5 * gaze}
    return curves, angles


def checks(curves, angles):
    return [(one.check, one.channel) for one in curve_checks.find(curves, NAMES, LIMITS, angles)]


@pytest.mark.parametrize("seed", range(5))
def test_a_clean_take_has_no_findings(seed):
    assert checks(*performance(seed)) == []


def exchanged(curves, *pairs):
    renamed = dict(curves)
    for a, b in pairs:
        renamed[a], renamed[b] = curves[b], curves[a]
    return renamed


@pytest.mark.parametrize("seed", range(3))
def test_planted_faults_are_named_and_nothing_else(seed):
    curves, angles = performance(seed)
    jaw = [("jawLeft", "jawRight")]
    left_eye = [("eyeLookInLeft", "eyeLookOutLeft")]
    sides = [("eyeLookInLeft", "eyeLookInRight"), ("eyeLookOutLeft", "eyeLookOutRight")]
    gaze, sideways = " ".join(curve_checks.GAZE), " ".join(curve_checks.SIDEWAYS)
    faults = [
        ({name: 100 * values for name, values in curves.items()}, [("range_0_100", "")]),
        (curves | {"jawOpen": 4 * curves["jawOpen"]}, [("beyond_range", "jawOpen")]),
        (curves | {"mouthClose": curves["mouthClose"] - 0.9}, [("beyond_range", "mouthClose")]),
        (exchanged(curves, *jaw), [("sides_swapped", sideways)]),
        (exchanged(curves, *left_eye), [("sides_swapped", gaze)]),
        (exchanged(curves, *sides), [("sides_swapped", gaze)]),
        (curves | {"mouthClose": 1 - curves["jawOpen"]}, [("mouth_close", "mouthClose")]),
        (curves | {"mouthSmileLeft": np.zeros(400)}, [("all_zero", "mouthSmileLeft")]),
        ({n: v for n, v in curves.items() if n != "mouthClose"}, [("missing", "mouthClose")]),
    ]
    for faulty, expected in faults:
        assert checks(faulty, angles) == expected


def test_values_a_little_beyond_one_are_no_fault():
    curves, angles = performance()
    assert checks(curves | {"jawOpen": 1.3 * curves["jawOpen"]}, angles) == []


def test_split_shapes_get_the_curve_and_shared_ones_the_mean():
    values = np.array([[0.2, 0.4, 1.0], [0.6, 0.0, 0.5]])
    weights = curve_mapping.apply(values, [[2], [2], [0, 1], []])
    np.testing.assert_allclose(weights, [[1, 1, 0.3, 0], [0.5, 0.5, 0.3, 0]])
    np.testing.assert_allclose(curve_mapping.motion(values), [0.2, 0.2, 0.25])


def test_angles_are_turns_about_z_then_x_then_y():
    angles = np.random.default_rng(0).uniform(-1, 1, (20, 3))

    def about(axis, angle):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[first, first] = turn[second, second] = np.cos(angle)
        turn[second, first], turn[first, second] = np.sin(angle), -np.sin(angle)
        return turn

    expected = [about(1, y) @ about(0, x) @ about(2, z) for y, x, z in angles]
    found = quaternions.from_angles(angles)
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1)
    again = quaternions.from_matrices(np.array(expected))
    np.testing.assert_allclose(np.abs(np.sum(found * again, axis=1)), 1)
