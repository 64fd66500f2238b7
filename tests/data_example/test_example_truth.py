import collections
import csv
import pathlib

import av
import numpy as np
import pytest
import trimesh
from scipy.spatial import transform

from data_example import generate
from data_example.generator import (
    contours,
    drawing,
    film,
    human_mesh,
    landmarks,
    mouth,
    params,
    radio,
    render,
    sculpting,
    selection,
    shots,
    truth,
)

FOLDER = pathlib.Path(generate.__file__).parent
TAKES = tuple(shots.TAKES)
CHARACTERS = {"human": human_mesh, "radio": radio, "drawing": drawing}


def known(name):
    with np.load(FOLDER / "truth" / f"{name}.npz") as arrays:
        return dict(arrays)


def labelled(name):
    frames = collections.defaultdict(dict)
    with (FOLDER / "labels" / f"{name}.csv").open(encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            frames[int(row["frame"])][row["point"]] = (float(row["x_px"]), float(row["y_px"]))
    return frames


def distance_to_line(point, line):
    start, step = line[:-1], np.diff(line, axis=0)
    along = ((point - start) * step).sum(axis=1) / np.maximum((step * step).sum(axis=1), 1e-12)
    nearest = start + np.clip(along, 0, 1)[:, None] * step
    return np.linalg.norm(nearest - point, axis=1).min()


@pytest.fixture(scope="module")
def brows():
    return landmarks.brows()


@pytest.mark.parametrize("name", TAKES)
def test_truth_is_made_again_from_its_seeds(name, brows):
    kept, made = known(name), truth.of_take(shots.TAKES[name](), brows)
    assert set(kept) == {*made, "occluded"}
    for key, value in made.items():
        if value.dtype.kind == "f":
            np.testing.assert_allclose(kept[key], value, atol=2e-3)
        else:
            assert (kept[key] == value).all()


@pytest.mark.parametrize("name", TAKES)
def test_film_has_as_many_pictures_as_the_truth_at_thirty_a_second(name):
    kept = known(name)
    with av.open(str(FOLDER / "films" / f"{name}.mp4")) as container:
        picture, sound = container.streams.video[0], container.streams.audio[0]
        assert (picture.codec_context.name, sound.codec_context.name) == ("h264", "aac")
        assert picture.average_rate == 30
        assert (picture.width, picture.height) == (render.WIDTH, render.HEIGHT)
        times = [packet.pts for packet in container.demux(picture) if packet.pts is not None]
        assert len(times) == shots.FRAMES[name] == len(kept["landmarks"])
    assert kept["occluded"].shape == kept["landmarks"].shape[:2]
    assert kept["occluded"].mean() < 0.05


@pytest.mark.parametrize("name", TAKES)
def test_labels_lie_on_the_true_contours(name, brows):
    take, off = shots.TAKES[name](), []
    for frame, points in labelled(name).items():
        p = params.from_row(take.expression[frame])
        turn = transform.Rotation.from_quat(take.quaternion[frame]).as_matrix()
        world = landmarks.moved(landmarks.in_space(p, brows), turn, take.translation[frame])
        lines = landmarks.in_picture(world)
        assert list(points) == contours.names(2)
        for contour, (kind, _, _) in contours.POINT_SET.items():
            line = lines[contour]
            line = np.concatenate([line, line[:1]]) if kind != "open" else line
            for point in (v for k, v in points.items() if k.startswith(contour)):
                off.append(distance_to_line(np.array(point), line))
    assert 0.1 < np.sqrt(np.mean(np.square(off))) < 0.45
    assert max(off) < 1.6


def test_a_dozen_frames_are_labelled_and_the_point_set_names_every_contour():
    assert sum(len(labelled(name)) for name in TAKES) == 12
    rows = (FOLDER / "point_set.tsv").read_text(encoding="utf-8").splitlines()
    assert rows[0] == "contour\tkind\tcount"
    assert [row.split("\t")[0] for row in rows[1:]] == list(contours.POINT_SET)


def test_closed_contours_run_from_the_left_of_the_picture_along_the_lower_edge():
    points = known("rom")["landmarks"][4]
    names = contours.names()
    for contour, (kind, count, _) in contours.POINT_SET.items():
        rows = [names.index(f"{contour}_{i:02d}") for i in range(count)] if kind == "closed" else []
        ring = points[rows]
        if kind == "closed":
            assert ring[:, 0].argmin() == 0
            assert ring[:, 0].argmax() == count // 2
            assert ring[count // 4, 1] >= ring[3 * count // 4, 1]
    assert points[names.index("brow_right_00"), 0] < points[names.index("brow_right_06"), 0]
    assert points[names.index("brow_left_00"), 0] > points[names.index("brow_left_06"), 0]
    assert points[names.index("pupil_right"), 0] < points[names.index("pupil_left"), 0]


@pytest.mark.parametrize("closing", [{}, {"lip_close": 1.0, "jaw_open": 0.4, "funnel": 0.5}])
def test_closed_lips_touch_along_their_whole_length(closing):
    ring = mouth.inner_curves({**params.neutral(), **closing})
    upper = np.concatenate([ring[mouth.HALF :], ring[:1]])[::-1]
    np.testing.assert_allclose(upper, ring[: mouth.HALF + 1], atol=1e-9)


def test_the_jaw_turns_on_a_hinge_so_the_opening_is_no_multiple_of_it():
    def drop(amount):
        p = {**params.neutral(), "jaw_open": amount}
        return (
            mouth.inner_curves(p)[mouth.HALF // 2]
            - mouth.inner_curves(params.neutral())[mouth.HALF // 2]
        )

    half, full = drop(0.5), drop(1.0)
    assert np.linalg.norm(full - 2 * half) > 0.03 * np.linalg.norm(full)
    assert landmarks.opening({**params.neutral(), "jaw_open": 1.0}) > 20


def test_talking_closes_and_opens_the_mouth_and_blinks_hide_the_pupils():
    kept = known("talk")
    assert (kept["opening_mm"] < 0.2).sum() > 40
    assert kept["opening_mm"].max() > 12
    blink = kept["expression"][:, list(kept["parameter_names"]).index("blink_l")] > 0.95
    pupil = kept["occluded"][:, list(kept["point_names"]).index("pupil_left")]
    assert pupil[blink].all()
    assert not pupil[kept["opening_mm"].argmax()]


def test_camera_noise_is_the_same_for_the_same_seed_and_frame():
    grey = np.full((8, 8, 3), 0.5, np.float32)
    assert (film.noisy(grey, 1, 5) == film.noisy(grey, 1, 5)).all()
    assert (film.noisy(grey, 1, 5) != film.noisy(grey, 1, 6)).any()


@pytest.fixture(scope="module")
def rewritten(tmp_path_factory):
    folder = tmp_path_factory.mktemp("characters")
    sculpting.write_all(folder)
    return folder


def test_characters_are_made_again_byte_by_byte(rewritten):
    kept = FOLDER / "characters"
    names = sorted(p.relative_to(rewritten) for p in rewritten.rglob("*") if p.is_file())
    assert names == sorted(p.relative_to(kept) for p in kept.rglob("*") if p.is_file())
    for name in names:
        assert (rewritten / name).read_bytes() == (kept / name).read_bytes(), name


def test_locked_frames_are_those_that_are_sculpted():
    text = (FOLDER.parent / "config" / "key_shapes.tsv").read_text(encoding="utf-8")
    locks = [tuple(row.split("\t")) for row in text.splitlines()[1:]]
    assert [(r, int(f)) for _, r, _, f, _ in locks] == [
        (region, frame) for region, frames in selection.LOCKED.items() for frame in frames
    ]
    for character in (*CHARACTERS, "puppet"):
        for _, region, shot, frame, _ in locks:
            folder = FOLDER / "characters" / character / "sculpts" / region
            assert list(folder.glob(f"{shot}_f{int(frame):04d}.*"))


@pytest.mark.parametrize("name", CHARACTERS)
def test_meshes_are_read_by_another_reader_and_are_small(name):
    path = FOLDER / "characters" / name / "neutral.obj"
    mesh = trimesh.load(path, process=False, maintain_order=True)
    character = CHARACTERS[name].build(params.neutral())
    assert len(mesh.vertices) == len(character.colours) <= 800
    pose = character.pose(params.neutral())
    np.testing.assert_allclose(mesh.vertices, pose, atol=0.6 * 10.0**-character.digits)
    assert mesh.visual.kind == "vertex"
    assert max(max(face) for face in character.faces) < len(pose)


@pytest.mark.parametrize("name", CHARACTERS)
def test_sculpts_are_about_a_tenth_off_the_true_pose(name):
    character = CHARACTERS[name].build(params.neutral())
    neutral = character.pose(params.neutral())
    table, off = shots.TAKES["rom"]().expression, []
    for region, frames in selection.LOCKED.items():
        for frame in frames:
            path = FOLDER / "characters" / name / "sculpts" / region / f"rom_f{frame:04d}.obj"
            made = trimesh.load(path, process=False, maintain_order=True).vertices
            true = character.pose(params.only(params.from_row(table[frame]), region))
            off.append(np.linalg.norm(made - true) / np.linalg.norm(true - neutral))
    assert 0.05 < np.mean(off) < 0.16
    assert max(off) < 0.45


def test_everything_stays_small():
    sizes = [
        p.stat().st_size for p in FOLDER.rglob("*") if p.is_file() and "__pycache__" not in p.parts
    ]
    assert sum(sizes) < 14e6
    assert max(sizes) < 3e6
