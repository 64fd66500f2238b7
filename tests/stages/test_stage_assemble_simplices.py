import logging
import re

import layered_actor
import numpy as np
import pytest
from layered_actor import EXTREMES, FIRST, LIPS, MARKERS, MASKS, POINTS

from stages.core import coordinate_balance, lip_seam
from stages.files import errors, layer_points, layers, simplices


@pytest.fixture
def actor(tmp_path):
    return layered_actor.LayeredActor(tmp_path)


def test_extremes_come_back(actor):
    made = simplices.read(actor.assemble())
    assert made.extremes == EXTREMES and made.masks == MASKS
    assert [tuple(group) for group in made.layout] == [("markers", MARKERS), ("video", POINTS)]
    np.testing.assert_allclose(made.basis, actor.basis, atol=1e-6)
    np.testing.assert_array_equal(made.layer, layered_actor.LAYER)
    group = np.repeat([0, 1], actor.sizes)
    expected = coordinate_balance.factors(made.basis, group, made.mask_weights, "mask_variance")
    np.testing.assert_allclose(made.scale, expected, rtol=1e-12)
    np.testing.assert_array_equal(made.mask_weights.argmax(axis=0), actor.mask)
    np.testing.assert_array_equal(made.mask_weights.max(axis=0), 1)
    upper, lower = actor.neutrals[1][6:8] + actor.basis[actor.sizes[0] :, 6].reshape(-1, 2)[6:8]
    assert made.closed_gap == pytest.approx(np.linalg.norm(upper - lower), abs=1e-6)
    # the vertices of this character meet nowhere: the actor's gaps are used
    lips = actor.basis[actor.sizes[0] :].reshape(-1, 2, len(EXTREMES))[6:8]
    apart = (actor.neutrals[1][6] - actor.neutrals[1][7])[:, None] + lips[0] - lips[1]
    wanted = np.maximum(np.linalg.norm(apart, axis=0) - made.closed_gap, 0)
    np.testing.assert_allclose(made.gaps, wanted, atol=1e-6)
    assert not made.gap_weights.any()


def test_the_gaps_are_the_characters_own_where_its_lips_meet(actor, caplog):
    actor.write_mouth(open_poses=[("emotion", "joy"), ("speech", "aa")])
    with caplog.at_level(logging.INFO):
        made = simplices.read(actor.assemble())
    opened = np.flatnonzero(made.gaps)
    assert [EXTREMES[k] for k in opened] == [("emotion", "joy"), ("speech", "aa")]
    np.testing.assert_allclose(made.gaps[opened], 0.5 - lip_seam.TOUCH / 2)
    assert "the actor's gaps are used" not in caplog.text
    assert simplices.lip_indices(made) == (1, 1, EXTREMES.index(("speech", "m")))
    assert set(actor.report().values()) == {"used"} and len(actor.report()) == len(EXTREMES)


@pytest.mark.parametrize(("points", "kinds"), [("video", ["video"]), ("markers", ["markers"])])
def test_either_kind_alone(actor, points, kinds):
    made = simplices.read(actor.assemble(points=points))
    assert [group.kind for group in made.layout] == kinds
    first, last = (0, actor.sizes[0]) if points == "markers" else (actor.sizes[0], None)
    np.testing.assert_allclose(made.basis, actor.basis[first:last], atol=1e-6)


def test_one_shot_need_not_hold_everything(actor):
    """Extremes of several shots make one vector, whatever the order of their points."""
    actor.picked[0][3:] = ["play", "7"]
    actor.write()
    made = simplices.read(actor.assemble(balance="published"))
    np.testing.assert_allclose(made.basis[:, 0], actor.offsets["play"][7], atol=1e-6)
    assert len(np.unique(made.scale)) == 1


def test_what_one_side_lacks_is_reported_and_the_rest_works(actor, caplog):
    del actor.picked[EXTREMES.index(("emotion", "rage"))]
    actor.write()
    actor.write_character([e for e in EXTREMES if e not in [("speech", "oo"), ("emotion", "joy")]])
    with caplog.at_level(logging.INFO):
        made = simplices.read(actor.assemble())
    lacking = [("emotion", "joy"), ("emotion", "rage"), ("speech", "oo")]
    assert made.extremes == [extreme for extreme in EXTREMES if extreme not in lacking]
    assert [actor.report()[extreme] for extreme in lacking] == [
        "missing on the character",
        "missing on the actor",
        "missing on the character",
    ]
    assert "emotion joy: missing on the character, save its pose as emotion_joy" in caplog.text


@pytest.mark.parametrize("kept", [[], [("speech", "rest")]])
def test_a_character_without_a_layer_works_with_the_others(actor, caplog, kept):
    actor.write_character([e for e in EXTREMES if e[0] != "speech" or e in kept])
    made = simplices.read(actor.assemble())
    assert made.layers == ["emotion", "blink"] and made.layer.tolist() == [0] * 5 + [1] * 3
    assert simplices.lip_indices(made) == (-1, -1, -1) and np.isnan(made.closed_gap)
    assert "layer speech is left out" in caplog.text
    expected = "left out" if kept else "missing on the character"
    assert actor.report()["speech", "rest"] == expected


def test_points_missing_on_an_extreme_are_left_out_and_reported(actor):
    actor.offsets["faces"][FIRST + 2, :3] = np.nan
    actor.offsets["faces"][FIRST + 5, actor.sizes[0] + 1] = np.nan
    actor.write()
    made = simplices.read(actor.assemble())
    assert layer_points.point_names(made.layout) == [*MARKERS[1:], *POINTS[1:]]
    assert len(made.basis) == len(made.scale) == len(actor.basis) - 5
    assert np.isfinite(made.basis).all()
    report = actor.report()
    assert report["", MARKERS[0]] == report["", POINTS[0]] == "left out"
    actor.offsets["faces"][FIRST + 2] = np.nan
    actor.write()
    message = "42 of the 42 points were not observed on some frame, such as U0, not observed on "
    with pytest.raises(errors.InputError, match=message + "emotion grief, frame 12 of faces: pick"):
        actor.assemble()


def test_points_of_no_weight_are_left_out_and_reported(actor):
    actor.masks.append(["mia", "upper", "U0", "0"])
    actor.masks[1] = ["mia", "mouth", "lips", "0"]
    actor.write()
    made = simplices.read(actor.assemble(lip_points="M0,M1"))
    kept = [name for name in POINTS if not name.startswith("lips")]
    assert layer_points.point_names(made.layout) == [*MARKERS[1:], *kept]
    report = actor.report()
    assert report["", "U0"] == report["", "lips_03"] == "left out"
    np.testing.assert_allclose(made.mask_weights.sum(axis=0), 1)
    found = layers.read(actor.transfer())
    np.testing.assert_allclose(found.weights, actor.weights, atol=1e-3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda rows: rows.clear(), "has no row for actor mia: pick frames"),
        (lambda rows: rows[4].__setitem__(2, "angr"), "line 6, column name: emotion has no extreme "
         "'angr', the nearest is anger"),
        (lambda rows: rows[4].__setitem__(1, "mood"), "line 6, column layer: 'mood' is no layer: "
         "write emotion, speech, blink"),
        (lambda rows: rows[4].__setitem__(3, "other"), "line 6, column shot: 'other' is none of "),
        (lambda rows: rows[4].__setitem__(4, "99"), "line 6, column frame: faces has frames 0 to "
         "21, not 99: write the frame that shows contempt"),
        (lambda rows: rows[4].__setitem__(4, "x"), "line 6, column frame: 'x' is not a whole"),
        (lambda rows: rows[4].__setitem__(4, "13"), "line 6: rage and contempt of layer emotion "
         "are one frame, 13 of faces: pick another"),
        (lambda rows: rows[4].__setitem__(2, "rage"), "line 6: emotion rage stands in line 5 "),
        (lambda rows: rows.__delitem__(slice(10, 12)), "line 11: open is the one extreme of layer "
         "blink: pick a second"),
        (lambda rows: rows.__delitem__(6), "mia has no row for speech m, the closed lips: add it, "
         "or set lip_sigma to 0"),
    ],
)  # fmt: skip
def test_bad_rows_are_one_line(actor, change, message):
    change(actor.picked)
    actor.write()
    with pytest.raises(errors.InputError, match=rf"expressions\.tsv: {re.escape(message)}"):
        actor.assemble()


def test_one_frame_may_show_extremes_of_two_layers(actor):
    actor.picked[0][4] = actor.picked[5][4]
    actor.write()
    made = simplices.read(actor.assemble())
    np.testing.assert_array_equal(made.basis[:, 0], made.basis[:, 5])


def test_extremes_that_nearly_coincide_are_named(actor, caplog):
    near = actor.basis[:, 1] + 0.01 * actor.basis[:, 2]
    actor.offsets["faces"][FIRST + 3] = near
    actor.write()
    message = (
        r"expressions\.tsv: lines 3 and 5: emotion joy and rage are 0\.00\d+ face units apart, "
        r"0\.\d% of the mean distance in the layer: pick frames that differ more, or remove one"
    )
    with pytest.raises(errors.InputError, match=message):
        actor.assemble()
    actor.offsets["faces"][FIRST + 3] = actor.basis[:, 1] + 0.1 * actor.basis[:, 2]
    actor.write()
    actor.assemble()
    assert "emotion joy and rage are 0.0" in caplog.text and "may not tell them" in caplog.text


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"lip_points": ""}, "--lip-points: is empty: name two points of the lips"),
        ({"lip_points": "lips_00,nose"}, "has no two points lips_00 and nose of one kind"),
        ({"lip_mask": "muzzle"}, "--lip-mask: 'muzzle' is no mask, they are upper, mouth, eyes"),
        ({"lip_sigma": -1}, "--lip-sigma: is -1"),
        ({"lip_sigma": "nan"}, "--lip-sigma: is nan"),
        ({"shots": ["faces"]}, "--shots: 1 names for 2 expressions"),
    ],
)
def test_other_bad_input_is_one_line(actor, changed, message):
    with pytest.raises(errors.InputError, match=message):
        actor.assemble(**changed)


def test_without_the_lip_bias_nothing_of_the_lips_is_needed(actor):
    del actor.picked[6]
    actor.write()
    made = simplices.read(actor.assemble(lip_sigma=0, lip_points="", lip_mask="muzzle"))
    assert (made.lip_mask, made.lip_points) == ("", "") and np.isnan(made.closed_gap)


def test_bad_characters_are_one_line(actor):
    actor.write_character(EXTREMES, [*MASKS, "tail"])
    with pytest.raises(errors.InputError, match="lacks the character's mask 'tail' for actor mia"):
        actor.assemble()
    actor.write_character(EXTREMES, MASKS[:2])
    with pytest.raises(errors.InputError, match="the character has no mask 'eyes', its masks are "):
        actor.assemble()
    actor.write_character([e for e in EXTREMES if e != ("speech", "m")])
    with pytest.raises(errors.InputError, match=r"poses\.parquet: the character has no pose spee"):
        actor.assemble()
    actor.write_character([("emotion", "neutral"), ("blink", "open")])
    with pytest.raises(errors.InputError, match="no layer has two extremes that the actor has too"):
        actor.assemble()


def test_lips_that_were_not_seen_closed_are_one_line(actor):
    actor.offsets["faces"][FIRST + 6, actor.sizes[0] + 12] = np.nan
    actor.write()
    with pytest.raises(errors.InputError, match=f"line 8: {LIPS} were not observed on that frame"):
        actor.assemble()


def test_a_kind_that_never_moves_is_one_line(actor):
    actor.offsets["faces"][:, : actor.sizes[0]] = 0.0
    actor.write()
    with pytest.raises(errors.InputError, match="the markers points are at the neutral in every"):
        actor.assemble()


def test_the_same_input_gives_the_same_bytes(actor):
    first = actor.assemble().read_bytes()
    assert actor.assemble().read_bytes() == first
