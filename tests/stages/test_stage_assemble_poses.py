import logging

import numpy as np
import pytest
from small_take import changed_by, words, write_obj

from stages import assemble_poses
from stages.core import compose, local_shapes
from stages.files import errors, poses, rig

EXTREMES = "stages/tables/extremes.tsv"
SIDES = ["upper", "mouth", "eyes"]
FACES = [(0, 1, 2), (0, 2, 3), (3, 2, 4)]
NEUTRAL = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 2, 0]])
# mouth below, eyes at the top, upper between them
MASKS = {
    "upper": [0, 0, 0.25, 1, 0.5],
    "mouth": [1, 1, 0.75, 0, 0],
    "eyes": [0, 0, 0, 0, 0.5],
}
POSES = {
    "speech_m": np.array([[0, 0.1, 0], [0, 0.2, 0], [0, 0.5, 0], [0, 0, 0], [0, 0, 0]]),
    "emotion_joy": np.array([[0.2, 0, 0], [0, 0, 0], [0, 0, 1], [0, 0.5, 0], [0, 0, 0.5]]),
    "blink_closed": np.array([[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, -1, 0]]),
}


def write_ply(path, vertices, colours):
    """Write a painted mesh as text, colours as bytes."""
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"property uchar {name}" for name in ("red", "green", "blue")] if colours else []
    lines += ["end_header"]
    for row, vertex in enumerate(vertices):
        cells = [f"{value:.6f}" for value in vertex]
        cells += [str(value) for value in colours[row]] if colours else []
        lines.append(" ".join(cells))
    path.write_text("\n".join(lines) + "\n")


class Character:
    """A folder with a neutral, its masks and some poses."""

    def __init__(self, folder, given=POSES):
        self.folder = folder
        (folder / "poses").mkdir()
        write_obj(folder / "neutral.obj", NEUTRAL, FACES)
        rows = [
            f"{vertex}\t{mask}\t{weight}"
            for mask, weights in MASKS.items()
            for vertex, weight in enumerate(weights)
        ]
        (folder / "masks.tsv").write_text("\n".join(["vertex\tregion\tweight", *rows]) + "\n")
        for name, delta in given.items():
            write_obj(folder / "poses" / f"{name}.obj", NEUTRAL + delta, FACES)

    def assemble(self, shapes=(), **changed):
        options = {
            "neutral": f"{self.folder}/neutral.obj",
            "pose-folder": f"{self.folder}/poses",
            "masks": f"{self.folder}/masks.tsv",
            "painted-masks": "",
            "extremes": EXTREMES,
            "unit": "cm",
            "up-axis": "y",
            "pivot": "0 -1 2",
            "face-unit": "6.5",
            "rig": f"{self.folder}/rig.npz",
            "poses-table": f"{self.folder}/poses.parquet",
        } | changed_by(changed)
        given = sorted(map(str, (self.folder / "poses").iterdir()))
        shapes = ["--shapes", *map(str, shapes)]
        assemble_poses.main([*words(options), "--poses", *given, *shapes])
        return rig.read_any(self.folder / "rig.npz"), poses.read(self.folder / "poses.parquet")


@pytest.fixture
def character(tmp_path):
    return Character(tmp_path)


def moved(made, columns):
    """Return where the bake's own formula puts the vertices for weights by column."""
    weights = np.array([[columns.get(name, 0.0) for name in made.names]])
    masked = local_shapes.masked(made.deltas, made.masks, made.mask_index)
    return compose.compose(made.neutral, compose.blocks(masked), weights)[0]


def test_the_rig_composes_what_the_contract_says(character):
    made, _ = character.assemble()
    rng = np.random.default_rng(1)
    pairs = {(mask, pose): rng.uniform() for mask in SIDES for pose in POSES}
    expected = NEUTRAL + sum(
        weight * np.array(MASKS[mask])[:, None] * POSES[pose]
        for (mask, pose), weight in pairs.items()
    )
    columns = {f"{mask}.{pose}": weight for (mask, pose), weight in pairs.items()}
    np.testing.assert_allclose(moved(made, columns), expected, atol=1e-7)


def test_pairs_without_motion_have_no_column_and_deltas_stay_under_their_mask(character):
    made, _ = character.assemble()
    assert made.names == [
        "upper.emotion_joy",
        "upper.speech_m",
        "upper.blink_closed",
        "mouth.emotion_joy",
        "mouth.speech_m",
        "eyes.emotion_joy",
        "eyes.blink_closed",
    ]
    deltas = local_shapes.dense(made.deltas)
    for name, mask, delta in zip(made.names, made.mask_index, deltas, strict=True):
        held = made.masks[mask] > 0
        assert not delta[~held].any()
        np.testing.assert_allclose(delta[held], POSES[name.partition(".")[2]][held], atol=1e-8)


def test_the_table_lists_every_extreme_and_what_stands_for_those_at_rest(character):
    write_obj(character.folder / "poses" / "blink_open.obj", NEUTRAL, FACES)
    _, listed = character.assemble()
    assert listed == [
        poses.Pose("emotion", "neutral", "neutral", 0),
        poses.Pose("emotion", "joy", "emotion_joy.obj", 4),
        poses.Pose("speech", "rest", "neutral", 0),
        poses.Pose("speech", "m", "speech_m.obj", 3),
        poses.Pose("blink", "open", "blink_open.obj", 0),
        poses.Pose("blink", "closed", "blink_closed.obj", 1),
    ]


def test_a_character_may_lack_a_layer(tmp_path, caplog):
    given = {name: delta for name, delta in POSES.items() if not name.startswith("blink")}
    with caplog.at_level(logging.INFO):
        made, listed = Character(tmp_path, given).assemble()
    assert "no pose of the layer blink" in caplog.text
    assert {row.layer for row in listed} == {"emotion", "speech"}
    assert not [name for name in made.names if "blink" in name]


def test_painted_colours_are_masks_whatever_their_brightness(character):
    path = character.folder / "painted.ply"
    colours = [(9, 0, 0), (0, 200, 0), (60, 180, 0), (0, 0, 255), (20, 0, 60)]
    write_ply(path, NEUTRAL, colours)
    made, _ = character.assemble(masks=str(path), painted_masks="upper, mouth,eyes")
    assert made.mask_names == SIDES
    expected = [[1, 0, 0.25, 0, 0.25], [0, 1, 0.75, 0, 0], [0, 0, 0, 1, 0.75]]
    np.testing.assert_allclose(made.masks, expected, atol=1e-12)
    np.testing.assert_allclose(made.masks.sum(axis=0), 1.0, atol=1e-15)


def test_a_pose_may_be_a_table_of_blendshapes(character):
    rng = np.random.default_rng(2)
    deltas = {name: rng.normal(size=NEUTRAL.shape) for name in ("jawOpen", "smile", "frown")}
    shapes = [character.folder / "shapes" / f"{name}.obj" for name in deltas]
    for path in shapes:
        write_obj(path, NEUTRAL + deltas[path.stem], FACES)
    table = character.folder / "poses" / "speech_aa.csv"
    table.write_text("name,value\njawOpen,0.8\nsmile,0.25\n")
    made, listed = character.assemble(shapes)
    columns = {f"{mask}.speech_aa": 1.0 for mask in SIDES}
    expected = NEUTRAL + 0.8 * deltas["jawOpen"] + 0.25 * deltas["smile"]
    np.testing.assert_allclose(moved(made, columns), expected, atol=1e-7)
    assert poses.Pose("speech", "aa", "speech_aa.csv", len(NEUTRAL)) in listed
    table.write_text("name,value\njawOpen,0.8\njawOpn,0.25\n")
    with pytest.raises(errors.InputError, match=r"speech_aa\.csv: line 3.*'jawOpn', is it jawOpen"):
        character.assemble(shapes)
    table.write_text("name,value\njawOpen,0.8\njawOpen,0.25\n")
    with pytest.raises(errors.InputError, match=r"line 3.*'jawOpen' stands twice"):
        character.assemble(shapes)


def test_tables_of_controls_have_poses_too(tmp_path):
    (tmp_path / "poses").mkdir()
    (tmp_path / "neutral.csv").write_text("name,value\njaw,1\nlid,2\n")
    (tmp_path / "masks.tsv").write_text(
        "vertex\tregion\tweight\njaw\tmouth\t1\nlid\tmouth\t0.5\nlid\teyes\t0.5\n"
    )
    (tmp_path / "poses" / "speech_m.csv").write_text("name,value\nlid,2\njaw,4\n")
    character = Character.__new__(Character)
    character.folder = tmp_path
    made, listed = character.assemble(neutral=f"{tmp_path}/neutral.csv")
    assert (made.names, made.controls) == (["mouth.speech_m"], ["jaw", "lid"])
    np.testing.assert_array_equal(moved(made, {"mouth.speech_m": 0.5})[:, 0], [2.5, 2])
    assert listed[-1] == poses.Pose("speech", "m", "speech_m.csv", 1)


@pytest.mark.parametrize(
    ("name", "vertices", "message"),
    [
        ("emotion_joi.obj", NEUTRAL, r"emotion_joi\.obj: .*no extreme.*is it emotion_joy\?"),
        ("speech_m.ply", NEUTRAL, r"speech_m\.ply: speech_m is also speech_m\.obj"),
        ("emotion_rage.obj", NEUTRAL[:-1], r"has 4 vertices, the neutral has 5"),
    ],
)
def test_poses_that_do_not_fit_are_named(character, name, vertices, message):
    write_obj(character.folder / "poses" / name, vertices, [])
    with pytest.raises(errors.InputError, match=message):
        character.assemble()
    assert not (character.folder / "rig.npz").exists()


def test_a_folder_without_motion_is_refused(tmp_path):
    character = Character(tmp_path, {})
    with pytest.raises(errors.InputError, match="holds no pose: save each extreme"):
        character.assemble()
    write_obj(tmp_path / "poses" / "emotion_joy.obj", NEUTRAL, FACES)
    with pytest.raises(errors.InputError, match="no pose differs from the neutral"):
        character.assemble()


RED = [(255, 0, 0)] * len(NEUTRAL)


@pytest.mark.parametrize(
    ("vertices", "colours", "names", "message"),
    [
        (NEUTRAL, [*RED[:2], (0, 0, 0), *RED[3:]], "a,b,c", "vertex 2 is black"),
        (NEUTRAL, RED, "a,b", "painted_masks is 'a,b': name three"),
        (NEUTRAL, RED, "", "painted_masks is '': name three"),
        (NEUTRAL, None, "a,b,c", "has no vertex colours"),
        (NEUTRAL[:4], RED[:4], "a,b,c", "has 4 vertices, the neutral has 5"),
        (NEUTRAL[[0, 1, 3, 2, 4]], RED, "a,b,c", "vertex 2 is not where the neutral has it"),
    ],
)
def test_paint_that_is_no_mask_is_refused(character, vertices, colours, names, message):
    path = character.folder / "painted.ply"
    write_ply(path, vertices, colours)
    with pytest.raises(errors.InputError, match=rf"painted\.ply: {message}"):
        character.assemble(masks=str(path), painted_masks=names)


def test_painted_masks_go_with_paint_only(character):
    with pytest.raises(errors.InputError, match=r"masks\.tsv: is a table.*leave upper"):
        character.assemble(painted_masks="upper,mouth,eyes")
