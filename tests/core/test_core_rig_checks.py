"""A drawn face as a rig: every planted fault is named, and nothing on the clean one."""

import numpy as np
import pytest

from stages.core import local_shapes, rig_checks

GRID = np.stack(np.meshgrid(np.linspace(-1, 1, 21), np.linspace(-1.6, 1.0, 27)), -1).reshape(-1, 2)
LIPS = np.array([[x, y] for y in (-0.79, -0.81) for x in np.linspace(-0.3, 0.3, 13)])
FLAT = np.concatenate([GRID[(np.abs(GRID[:, 1] + 0.8) > 0.05) | (np.abs(GRID[:, 0]) > 0.35)], LIPS])
NEUTRAL = np.column_stack([FLAT, 1.5 - (FLAT**2).sum(axis=1) / 4])
PLACES = {
    "eyeBlink": (0.5, 0.3, (0, -0.1, 0)),
    "eyeSquint": (0.5, 0.2, (0, 0.05, 0)),
    "browOuterUp": (0.7, 0.6, (0, 0.12, -0.02)),
    "browDown": (0.5, 0.5, (0, -0.1, 0)),
    "mouthSmile": (0.35, -0.8, (0.1, 0.15, 0)),
    "mouthFrown": (0.35, -0.85, (0, -0.1, 0)),
    "cheekSquint": (0.6, -0.1, (0, 0.08, 0)),
}


def bump(x, y, move, wide=0.2):
    near = np.exp(-((NEUTRAL[:, 0] - x) ** 2 + (NEUTRAL[:, 1] - y) ** 2) / (2 * wide**2))
    near[near < 0.05] = 0
    return near[:, None] * np.asarray(move, float)


def clean():
    jaw = np.where(NEUTRAL[:, 1] < -0.8, 0.4, 0.0)[:, None] * np.array([0, -1, -0.5])
    shapes = {"jawOpen": jaw, "mouthClose": -jaw * (np.abs(NEUTRAL[:, 1] + 0.8) < 0.04)[:, None]}
    for name, (x, y, move) in PLACES.items():
        shapes[f"{name}Left"] = bump(x, y, move)
        shapes[f"{name}Right"] = bump(-x, y, np.array(move) * [-1, 1, 1])
    for name, sign in (("Left", 1), ("Right", -1)):
        shapes[f"jaw{name}"] = bump(0, -1.2, (0.12 * sign, 0, 0), 0.3)
        shapes[f"mouth{name}"] = bump(0, -0.8, (0.15 * sign, 0.02, 0), 0.3)
    shapes["browInnerUp"] = bump(0, 0.6, (0, 0.1, 0))
    shapes["mouthPucker"] = bump(0, -0.8, (0, 0.02, 0.2))
    return shapes


def check(shapes, neutral=NEUTRAL, up_axis="y", face_unit=1.0, metres=0.06, known=None):
    known = known or clean()
    return rig_checks.find(
        list(shapes),
        neutral,
        local_shapes.gather(shapes.values()),
        {name: [name] if name in shapes else [] for name in known},
        {name: name.replace("Left", "Right") for name in known if name.endswith("Left")},
        (up_axis, face_unit, metres),
    )


def found(*arguments, **named):
    return [(one.check, one.shape) for one in check(*arguments, **named)]


def swapped(shapes, *names):
    made = dict(shapes)
    for name in names:
        made[f"{name}Left"], made[f"{name}Right"] = shapes[f"{name}Right"], shapes[f"{name}Left"]
    return made


@pytest.mark.parametrize("size", [0.01, 1.0, 60.0])
def test_nothing_is_said_of_a_clean_rig_in_any_unit(size):
    scaled = {name: delta * size for name, delta in clean().items()}
    assert check(scaled, NEUTRAL * size, "y", size, 0.06 / size) == []
    turned = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    up = {name: delta @ turned for name, delta in clean().items()}
    assert check(up, NEUTRAL @ turned, "z") == []


@pytest.mark.parametrize("name", [*PLACES, "jaw", "mouth"])
def test_a_swapped_pair_is_named(name):
    assert found(swapped(clean(), name)) == [("sides_swapped", f"{name}Left {name}Right")]


def test_a_rig_with_all_sides_swapped_gets_one_line():
    assert found(swapped(clean(), *PLACES, "jaw", "mouth")) == [("sides_swapped", "")]


@pytest.mark.parametrize("gain", [100, 0.01])
def test_sizes_are_named_of_one_or_of_all(gain):
    shapes = clean()
    assert found(shapes | {"eyeBlinkLeft": gain * shapes["eyeBlinkLeft"]}) == [
        ("size", "eyeBlinkLeft")
    ]
    assert found({name: gain * delta for name, delta in shapes.items()}) == [("size", "")]


def test_a_mouth_close_that_is_a_pose_of_its_own_is_named():
    shapes = clean()
    full = shapes["mouthClose"] + shapes["jawOpen"]
    (one,) = check(shapes | {"mouthClose": full})
    assert (one.check, "of jawOpen itself" in one.detail) == ("mouth_close", True)
    (one,) = check(shapes | {"mouthClose": 0.2 * shapes["mouthClose"]})
    assert (one.check, one.detail.split(" of ")[0]) == ("mouth_close", "takes back 20%")
    (one,) = check(shapes | {"mouthClose": 3 * shapes["mouthClose"]})
    assert (one.check, "pass through" in one.detail) == ("mouth_close", True)
    (one,) = check(shapes | {"mouthClose": bump(0.8, 0.2, (0, 0.1, 0))})
    assert (one.check, "moves none of the lips" in one.detail) == ("mouth_close", True)


def test_still_and_equal_shapes_are_named():
    shapes = clean()
    changed = shapes | {
        "mouthPucker": 0 * NEUTRAL,
        "eyeSquintLeft": 1.0001 * shapes["eyeBlinkLeft"],
    }
    assert found(changed) == [
        ("moves_nothing", "mouthPucker"),
        ("same", "eyeBlinkLeft eyeSquintLeft"),
    ]


def test_a_neutral_that_is_not_where_the_shapes_start_is_named():
    offset = 0.2 * clean()["jawOpen"]
    shapes = {name: delta - offset for name, delta in clean().items()}
    assert found(shapes, NEUTRAL + offset) == [("neutral", "")]
    scaled = {name: 0.1 * (NEUTRAL + delta) - NEUTRAL for name, delta in clean().items()}
    (one,) = check(scaled)
    assert (one.check, "about 0.1 times" in one.detail) == ("scale", True)


def test_units_and_axes_that_fit_no_face_are_named():
    assert found(clean(), up_axis="z") == [("axes", "")]
    assert found(clean(), face_unit=0.01) == [("unit", "")]
    assert found(clean(), metres=60.0) == [("unit", "")]


def test_what_a_rig_lacks_is_named_if_it_is_of_that_set():
    shapes = clean()
    lost = ("jawOpen", "eyeBlinkLeft")
    left = {name: delta for name, delta in shapes.items() if name not in lost}
    assert set(found(left)) == {("missing", name) for name in lost}
    few = {name: shapes[name] for name in ("jawOpen", "mouthClose", "eyeBlinkLeft")}
    assert found(few) == [("names", "")]
    own = {f"own_{name}": delta for name, delta in shapes.items()}
    assert found(own, known=shapes) == []


def test_controls_have_no_places():
    deltas = local_shapes.gather([np.array([[1.0], [0]]), np.zeros((2, 1))])
    made = rig_checks.find(["a", "b"], np.zeros((2, 1)), deltas, {}, {}, ("y", 1.0, 1.0))
    assert [(one.check, one.shape) for one in made] == [("moves_nothing", "b")]
