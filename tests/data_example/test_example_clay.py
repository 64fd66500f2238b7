"""The clay head of the example: its shapes, its virtual markers and its tuned pairs."""

import csv
import pathlib

import numpy as np
import pytest
import trimesh

from data_example import generate
from data_example.generator import (
    capture,
    clay,
    clay_rig,
    clay_shapes,
    markers,
    params,
    shots,
    skin,
    tuned_pairs,
)

FOLDER = pathlib.Path(generate.__file__).parent / "characters" / "clay"
PAIRS = {"anna": 60, "ben": 40, "anna_film": 36}
SIDES = ("Left", "Right")
# of the capture's files and the clay head's, with the voice and the truth that they need
LIMIT = 3e6


@pytest.fixture(scope="module")
def mia_skin():
    body = skin.build()
    return body, markers.glue(body)


@pytest.fixture(scope="module")
def rig():
    return clay_rig.build()


def vertices(path):
    return trimesh.load(path, process=False, maintain_order=True).vertices


def posed(rig, **weights):
    return rig.neutral + sum(w * rig.deltas[name] for name, w in weights.items())


def table(path):
    with path.open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream, delimiter="\t"))


def test_files_hold_the_rig_in_one_topology(rig):
    neutral = trimesh.load(FOLDER / "neutral.ply", process=False, maintain_order=True)
    assert 600 <= len(neutral.vertices) <= 1000
    assert neutral.visual.kind == "vertex"
    np.testing.assert_allclose(neutral.vertices, rig.neutral, atol=1e-5)
    files = sorted((FOLDER / "shapes").iterdir())
    assert [path.stem for path in files] == sorted(clay_shapes.NAMES)
    for path in files:
        shape = trimesh.load(path, process=False, maintain_order=True)
        assert (shape.faces == neutral.faces).all()
        np.testing.assert_allclose(shape.vertices - rig.neutral, rig.deltas[path.stem], atol=1e-5)


def test_there_are_46_shapes_and_none_is_made_of_others(rig):
    assert len(set(clay_shapes.NAMES)) == 46
    flat = np.stack([rig.deltas[name].ravel() for name in clay_shapes.NAMES])
    flat /= np.linalg.norm(flat, axis=1)[:, None]
    assert np.linalg.svd(flat, compute_uv=False)[-1] > 0.003


def test_shapes_are_local_and_what_they_leave_alone_is_exactly_zero(rig):
    neutral = vertices(FOLDER / "neutral.ply")
    for name in clay_shapes.NAMES:
        moves = (vertices(FOLDER / "shapes" / f"{name}.ply") != neutral).any(axis=1)
        assert 8 < moves.sum() < (0.5 if name.startswith(("jaw", "mouth")) else 0.2) * len(moves)
        if name.endswith("Left") and name not in ("jawLeft", "mouthLeft"):
            assert (rig.neutral[moves, 0] > -1).all()
        if name.endswith("Right") and name not in ("jawRight", "mouthRight"):
            assert (rig.neutral[moves, 0] < 1).all()


def test_left_and_right_shapes_mirror_each_other(rig):
    for name in clay_shapes.NAMES:
        if not name.endswith("Left"):
            continue
        left, right = rig.deltas[name], rig.deltas[name[:-4] + "Right"]
        sizes = [np.linalg.norm(d) for d in (left, right)]
        assert sizes[0] == pytest.approx(sizes[1], rel=0.02), name
        total = left.sum(axis=0) * [-1, 1, 1]
        np.testing.assert_allclose(total, right.sum(axis=0), atol=0.03 * sizes[0] + 0.2)


def lid_gap(points, number):
    first = (clay.INNER + 5) * clay.RINGS + number * 6 * clay.LIDS + clay.LIDS
    ring = points[first : first + clay.LIDS]
    half = clay.LIDS // 2
    return np.linalg.norm(ring[1:half] - ring[:half:-1], axis=1)


def lip_gap(points):
    ring = points[clay.INNER * clay.RINGS : (clay.INNER + 1) * clay.RINGS]
    half = clay.RINGS // 2
    return np.linalg.norm(ring[1:half] - ring[:half:-1], axis=1)


def test_blinks_close_the_lids_of_their_own_eye(rig):
    for number, side in enumerate(("Right", "Left")):
        assert lid_gap(rig.neutral, number).max() > 1.5
        shut = posed(rig, **{f"eyeBlink{side}": 1})
        assert lid_gap(shut, number).max() < 0.02
        assert (lid_gap(shut, 1 - number) == lid_gap(rig.neutral, 1 - number)).all()


def test_the_jaw_opens_the_mouth_and_mouth_close_shuts_it(rig):
    assert lip_gap(rig.neutral).max() < 1e-6
    assert lip_gap(posed(rig, jawOpen=1)).max() > 2
    assert lip_gap(posed(rig, jawOpen=1, mouthClose=1)).max() < 0.02
    assert lip_gap(posed(rig, jawOpen=0.4, mouthClose=0.4)).max() < 0.02


def test_proportions_are_quite_unlike_the_subjects(rig, mia_skin):
    lower = {row["point"]: int(row["vertex"]) for row in table(FOLDER / "virtual_markers.tsv")}
    subject, _ = markers.still(*mia_skin, params.neutral())
    head = np.stack([rig.neutral[lower[name]] for name in markers.NAMES])

    def span(points, first, second):
        return np.linalg.norm(
            points[markers.NAMES.index(first)] - points[markers.NAMES.index(second)]
        )

    ratios = [
        span(head, *ends) / span(subject, *ends)
        for ends in (("RECO", "LECO"), ("RMTH", "LMTH"), ("MNOS4", "MCHN2"), ("GLAB", "MNOS4"))
    ]
    assert max(ratios) / min(ratios) > 1.3


def test_every_marker_has_a_vertex_of_its_own_on_the_skin(rig):
    rows = table(FOLDER / "virtual_markers.tsv")
    assert [row["point"] for row in rows] == list(markers.NAMES)
    numbers = [int(row["vertex"]) for row in rows]
    assert len(set(numbers)) == 102
    assert max(numbers) < rig.skin
    at = {row["point"]: rig.neutral[int(row["vertex"])] for row in rows}
    for name in markers.SIDE:
        assert at["L" + name][0] > 0 > at["R" + name][0]
    assert at["MULP"][1] > at["MLLP"][1] > at["MCHN1"][1] > at["MCHN3"][1]
    moved = np.array([max(np.abs(d[n]).max() for d in rig.deltas.values()) for n in numbers])
    assert (moved > 0.05).mean() > 0.75


@pytest.mark.parametrize("animator", PAIRS)
def test_pairs_are_true_weights_a_few_hundredths_off(animator):
    rows = table(FOLDER / "pairs" / f"{animator}.tsv")
    assert len(rows) == PAIRS[animator]
    shot = "rom" if animator == "anna_film" else "capture"
    assert {row["shot"] for row in rows} == {shot}
    frames = [int(row["frame"]) for row in rows]
    assert len(set(frames)) == len(frames)
    weights = clay_shapes.weights(tuned_pairs.performance(shot)[0])
    assert max(frames) < len(weights) - 5
    values = np.array([[float(row[n] or 0) for n in clay_shapes.NAMES] for row in rows])
    assert values.min() >= 0
    assert values.max() <= 1
    used = values > 0
    assert 0.02 < np.sqrt(np.mean((values - weights[frames])[used] ** 2)) < 0.04
    np.testing.assert_allclose(values, np.round(values, 2))


def test_both_animators_tune_frames_of_their_own_and_each_has_the_neutral_or_extremes():
    frames = {
        name: {int(row["frame"]) for row in table(FOLDER / "pairs" / f"{name}.tsv")}
        for name in ("anna", "ben")
    }
    assert not frames["anna"] & frames["ben"]
    assert tuned_pairs.NEUTRAL in frames["anna"]
    assert len(set(tuned_pairs.extreme_frames()) & (frames["ben"] | frames["anna"])) > 12


def test_true_weights_are_smooth_and_within_limits():
    for name in ("capture", "line", *shots.TAKES):
        weights = clay_shapes.weights(tuned_pairs.performance(name)[0])
        assert weights.min() >= 0
        assert weights.max() <= 1
    neutral = clay_shapes.weights(np.zeros((1, len(params.NAMES))))
    assert np.abs(neutral).max() < 1e-9


def test_a_ridge_on_the_pairs_carries_over_to_the_later_take(rig, mia_skin):
    rows = [row for name in ("anna", "ben") for row in table(FOLDER / "pairs" / f"{name}.tsv")]
    wanted = np.array([[float(row[n] or 0) for n in clay_shapes.NAMES] for row in rows])
    seen = tuned_pairs.performance("capture")[0][[int(row["frame"]) for row in rows]]
    later = tuned_pairs.performance("line")[0][::12]
    points = [capture.true_markers(*mia_skin, t)[0].reshape(len(t), -1) for t in (seen, later)]
    middle = points[0].mean(axis=0)
    known, unseen = (np.column_stack([p - middle, np.full(len(p), 30.0)]) for p in points)
    gram = known @ known.T + 30.0 * np.eye(len(known))
    found = np.clip(unseen @ known.T @ np.linalg.solve(gram, wanted), 0, 1)
    deltas = np.stack([rig.deltas[name].ravel() for name in clay_shapes.NAMES])
    true = clay_shapes.weights(later)
    off, size = (np.sqrt(np.mean((w @ deltas) ** 2)) for w in (found - true, true))
    assert off < 0.2 * size


def test_what_came_with_the_markers_stays_small():
    folder = FOLDER.parents[1]
    files = [*(folder / "capture").iterdir(), *FOLDER.rglob("*")]
    files += [folder / "truth" / f"{name}.npz" for name in ("capture", "line")]
    files += [folder / "generator" / name for name in ("voice.ogg", "phones.tsv")]
    assert sum(path.stat().st_size for path in files if path.is_file()) < LIMIT
