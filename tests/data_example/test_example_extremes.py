"""The planet and the cassette player, which are posed at the extremes of layers."""

import csv
import pathlib
from collections import Counter

import numpy as np
import pytest
import trimesh

from data_example import generate
from data_example.generator import (
    acting,
    cassette,
    cassette_parts,
    globe,
    globe_features,
)
from stages.files import mask_table, mesh

FOLDER = pathlib.Path(generate.__file__).parent / "characters"
TABLE = FOLDER.parents[1] / "stages" / "tables" / "extremes.tsv"
SIZES = {"globe": (1000, 1900, 750e3), "cassette": (720, 1100, 450e3)}
PLAYED = {
    "emotion": {
        "serenity", "joy", "ecstasy", "trust", "fear", "surprise", "amazement", "sadness", "grief",
        "disgust", "anger", "rage", "anticipation", "contempt",
    },
    "speech": {"m", "f", "th", "t", "sh", "r", "oo", "oh", "aa", "eh", "ee"},
    "blink": {"half", "closed"},
}  # fmt: skip
# of the character's size, within which what is closed is closed
GAP = 0.005


def globe_seams(points):
    """Return the two sides of each mouth and of each eye of the planet."""
    parts = globe.Globe().parts
    seams = {}
    for names, row in ((globe_features.MOUTHS, 2), (globe_features.EYES, 2)):
        for name in names:
            count = 4 if name in globe_features.MOUTHS else 3
            rings = points[parts.slices[name]].reshape(count, -1, 3)
            seams[name] = sides(rings[row])
    return seams


def cassette_seams(points):
    """Return the two sides of the compartment and of each speaker's shutters."""
    slices = cassette.Cassette().parts.slices
    rings = points[slices["mouth"]].reshape(-1, cassette_parts.RING, 3)
    seams = {"mouth": sides(rings[3])}
    for side in ("r", "l"):
        count = len(cassette_parts.LID)
        above, below = (points[slices[f"lid{n}_{side}"]] for n in ("up", "low"))
        seams[f"eye_{side}"] = above[:count], below[-count:]
    return seams


def sides(ring):
    """Return the lower side of a ring and the upper one, both from its first corner."""
    half = len(ring) // 2
    return ring[: half + 1], np.concatenate([ring[:1], ring[: half - 1 : -1]])


SEAMS = {"globe": globe_seams, "cassette": cassette_seams}


@pytest.fixture(scope="module", params=SIZES)
def character(request):
    folder = FOLDER / request.param
    poses = {path.stem: mesh.read(path) for path in sorted((folder / "poses").iterdir())}
    return request.param, mesh.read(folder / "neutral.ply"), poses


def masks_of(name, count):
    table = mask_table.read(FOLDER / name / "masks.tsv", [str(v) for v in range(count)], 3)
    return table.regions, table.given


def gaps(name, points):
    """Return the widest gap of every seam, as a share of the character's size."""
    seams = SEAMS[name](points)
    size = np.ptp(points, axis=0).max()
    return {k: np.linalg.norm(a - b, axis=1).max() / size for k, (a, b) in seams.items()}


def test_there_is_a_pose_for_each_extreme_and_no_other(character):
    _, _, poses = character
    assert set(poses) == {f"{layer}_{name}" for layer, names in PLAYED.items() for name in names}
    with TABLE.open(encoding="utf-8") as stream:
        known = {f"{row['layer']}_{row['name']}" for row in csv.DictReader(stream, delimiter="\t")}
    assert set(poses) <= known


def test_poses_keep_count_order_and_polygons(character):
    name, neutral, poses = character
    low, high, limit = SIZES[name]
    assert low <= len(neutral.vertices) <= high
    assert len(neutral.colours) == len(neutral.vertices)
    for pose in poses.values():
        assert len(pose.vertices) == len(neutral.vertices)
        assert (pose.corners == neutral.corners).all()
        assert (pose.sizes == neutral.sizes).all()
        assert not len(pose.colours)
    files = [path for path in (FOLDER / name).rglob("*") if path.is_file()]
    assert sum(path.stat().st_size for path in files) <= limit


def test_another_reader_finds_the_same(character):
    name, neutral, poses = character
    for path, own in (("neutral", neutral), ("poses/speech_aa", poses["speech_aa"])):
        other = trimesh.load(FOLDER / name / f"{path}.ply", process=False, maintain_order=True)
        np.testing.assert_allclose(other.vertices, own.vertices)
    assert own.sizes.min() == own.sizes.max() == 4


def test_polygons_agree_on_their_outside(character):
    _, neutral, _ = character
    quads = neutral.corners.reshape(-1, 4)
    edges = Counter()
    for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
        edges.update(map(tuple, quads[:, [a, b]]))
    assert max(edges.values()) == 1
    used = np.unique(quads)
    assert len(used) == len(neutral.vertices)


def test_masks_are_a_partition_of_unity_and_soft_where_parts_meet(character):
    name, neutral, _ = character
    regions, masks = masks_of(name, len(neutral.vertices))
    assert regions == ["upper", "mouth", "eyes"]
    assert masks.min() >= 0
    np.testing.assert_allclose(masks.sum(axis=0), 1, atol=1e-9)
    assert (masks == 1).any(axis=1).all()
    for row in (1, 2):
        assert ((masks[row] > 0.1) & (masks[row] < 0.9)).sum() > 20


def test_m_closes_every_mouth_and_aa_opens_it(character):
    name, _, poses = character
    closed, wide = (gaps(name, poses[f"speech_{n}"].vertices) for n in ("m", "aa"))
    mouths = [k for k in closed if k.startswith("mouth")]
    assert len(mouths) == (4 if name == "globe" else 1)
    assert all(closed[k] <= GAP for k in mouths)
    assert all(wide[k] > 6 * GAP for k in mouths)


def test_speech_opens_mouths_as_its_sounds_do(character):
    name, _, poses = character

    def shape(sound):
        lower, upper = SEAMS[name](poses[f"speech_{sound}"].vertices)[
            "mouth_grand" if name == "globe" else "mouth"
        ]
        width = np.linalg.norm(lower[0] - lower[-1])
        return width, np.linalg.norm(lower - upper, axis=1).max(), lower[:, 2].mean()

    width, height, ahead = np.transpose([shape(n) for n in ("aa", "oo", "ee")])
    assert width[2] > width[0] > 1.3 * width[1]
    assert height[0] > 2 * height[1]
    assert height[0] > 2 * height[2]
    assert ahead[1] > ahead[2]


def test_a_blink_shuts_every_eye_and_moves_no_mouth(character):
    name, neutral, poses = character
    rest, half, shut = (
        gaps(name, v.vertices) for v in (neutral, poses["blink_half"], poses["blink_closed"])
    )
    eyes = [k for k in shut if k.startswith("eye")]
    assert len(eyes) == (5 if name == "globe" else 2)
    for eye in eyes:
        assert shut[eye] <= GAP
        assert rest[eye] > half[eye] > 2 * GAP
    _, masks = masks_of(name, len(neutral.vertices))
    moved = (poses["blink_closed"].vertices != neutral.vertices).any(axis=1)
    assert not moved[masks[1] == 1].any()


def test_speech_moves_mouths_and_little_else_and_emotions_move_everything(character):
    name, neutral, poses = character
    _, masks = masks_of(name, len(neutral.vertices))
    size = np.ptp(neutral.vertices, axis=0).max()
    for pose, shape in poses.items():
        off = np.linalg.norm(shape.vertices - neutral.vertices, axis=1) / size
        if pose.startswith("speech"):
            assert not off[masks[2] == 1].any()
            assert off[masks[1] == 1].mean() > 4 * off[masks[0] == 1].mean()
        if pose.startswith("emotion"):
            assert (off > 0.001).mean() > 0.9
            assert off.max() < 0.7


def test_no_two_poses_are_alike(character):
    _, neutral, poses = character
    # half a blink lies between none and a whole one
    names = [name for name in poses if name != "blink_half"]
    flat = np.stack([(poses[name].vertices - neutral.vertices).ravel() for name in names])
    flat /= np.linalg.norm(flat, axis=1)[:, None]
    assert np.max(flat @ flat.T - np.eye(len(names))) < 0.99


def test_every_mouth_of_the_planet_has_its_own_manner():
    # cosines of what they do in joy: they differ by more than how much
    neutral, joy = acting.neutral(), acting.faces()["emotion", "joy"]
    moves = []
    for name in globe_features.MOUTHS:
        rest, posed = (globe_features.mouth(name, p)[0][2, :, :2] for p in (neutral, joy))
        at = np.linspace(0, len(rest) - 1, 12)
        move = [np.interp(at, np.arange(len(rest)), c) for c in (posed - rest).T]
        moves.append(np.ravel(move) / np.linalg.norm(move))
    assert np.max(np.abs(np.stack(moves) @ np.stack(moves).T - np.eye(4))) < 0.95


@pytest.mark.parametrize("emotion", ["joy", "amazement", "fear", "grief", "rage", "contempt"])
def test_features_stay_on_their_ground_while_they_speak(character, emotion):
    """What the emotion does to the body must not tear off a mouth that hardly follows it."""
    name, neutral, poses = character
    _, masks = masks_of(name, len(neutral.vertices))
    moved = poses[f"emotion_{emotion}"].vertices - neutral.vertices
    speech = poses["speech_aa"].vertices - neutral.vertices
    still = neutral.vertices
    mixed = still + (masks.T @ [0.95, 0.3, 0.4])[:, None] * moved
    mixed = mixed + (masks.T @ [0.05, 0.7, 0])[:, None] * speech
    quads = neutral.corners.reshape(-1, 4)
    one, other = quads[:, [0, 1]].ravel(), quads[:, [1, 2]].ravel()
    long = [
        np.linalg.norm(v[one] - v[other], axis=1)
        for v in (still, still + moved, still + speech, mixed)
    ]
    size = np.ptp(still, axis=0).max()
    assert (long[3] - np.max(long[:3], axis=0)).max() < 0.08 * size


def test_faces_are_those_of_the_layers():
    faces = acting.faces()
    assert {key[0] for key in faces} == set(PLAYED)
    assert all(set(p) == set(acting.neutral()) for p in faces.values())
