from fractions import Fraction

import av
import numpy as np
import pytest
from small_take import FRAMES, RATE, SmallTake, words

from stages import assemble_rig, bake_mesh, render_controls, render_preview, smooth_weights
from stages.core import marker_panel, preview
from stages.files import errors, film_writer, rig, series, weights

NAMES = [f"lips_{index:02d}" for index in range(4)]
MOUTH = np.array([[40, 60], [60, 70], [80, 60], [60, 50]], float)


@pytest.fixture(scope="module")
def take(tmp_path_factory):
    made = SmallTake(tmp_path_factory.mktemp("preview"))
    assemble_rig.main(made.rig_options())
    smooth_weights.main(made.weights_options())
    bake_mesh.main(made.bake_options())
    frames = [(number / 30, np.full((96, 128, 3), 90, np.uint8)) for number in range(FRAMES)]
    film_writer.write(made.folder / "film.mp4", frames, (128, 96), Fraction(30))
    write_tracked(made, range(FRAMES))
    (made.folder / "points.tsv").write_text("contour\tkind\tcount\nlips\tclosed\t4\n")
    (made.folder / "regions.tsv").write_text("region\tpoint\tweight\nmouth\tlips\t\n")
    return made


def write_tracked(take, frames):
    frames = np.array(frames)
    points = np.tile(MOUTH, (len(frames), 1, 1))
    points[0] = np.nan
    columns = series.unstack(points, NAMES)
    columns |= {f"{name}.confidence": np.ones(len(frames)) for name in NAMES}
    columns["confidence"] = np.where(np.arange(len(frames)) == 0, 0.0, 0.9)
    path = take.folder / "tracked.parquet"
    series.write(path, "tracked", frames, frames / 30, columns, RATE)


def options(take, **character):
    files = {"video": "film.mp4", "tracked": "tracked.parquet", "point-set": "points.tsv"}
    files |= {"regions": "regions.tsv", "preview": "preview.mp4"} | character
    paths = {flag: f"{take.folder}/{name}" for flag, name in files.items()}
    return words(paths | {"shot": "talk", "character": "face"})


def mesh_options(take):
    return options(take, exr="mesh.exr", json="mesh.json", rig="rig.npz")


def pictures(take):
    with av.open(str(take.folder / "preview.mp4")) as container:
        return [(f.time, f.to_ndarray(format="rgb24")) for f in container.decode(video=0)]


def test_the_preview_shows_contours_and_a_moving_character(take):
    render_preview.main(mesh_options(take))
    shown = pictures(take)
    assert len(shown) == FRAMES
    np.testing.assert_allclose([time for time, _ in shown], np.arange(FRAMES) / 30, atol=1e-3)
    width, height = preview.size(preview.film_width(128, 96))
    assert shown[0][1].shape == (height, width, 3)
    left = [picture[: preview.HEIGHT, : width - preview.HEIGHT].astype(int) for _, picture in shown]
    assert np.abs(left[0] - 90).max() < 30
    scale = preview.HEIGHT / 96
    column, row = (MOUTH[1] * scale).astype(int)
    assert left[5][row - 3 : row + 4, column, 0].max() > 180
    right = [picture[: preview.HEIGHT, -preview.HEIGHT :].astype(int) for _, picture in shown]
    assert np.abs(right[3] - right[12]).mean() > 2
    strips = [picture[preview.HEIGHT :, width // 2 :].astype(int) for _, picture in shown]
    assert (strips[0][:, :, 0] - strips[0][:, :, 2]).max() > 80
    assert (strips[5][:, :, 0] - strips[5][:, :, 2]).max() < 60


def test_only_the_frames_of_the_shot_are_shown(take):
    write_tracked(take, range(6, 16))
    render_preview.main(mesh_options(take))
    assert [round(30 * time) for time, _ in pictures(take)] == list(range(10))
    write_tracked(take, range(FRAMES))


def test_one_stray_frame_does_not_push_the_character_away(take, tmp_path):
    names = rig.read(take.folder / "rig.npz", "mesh").names
    read = weights.read(take.folder / "weights.parquet", names)
    long = {name: np.resize(read.shapes[:, column], 200) for column, name in enumerate(names)}
    columns = long | {"confidence": np.ones(200)}
    still = np.tile([0.0, 0, 0, 1], (200, 1))
    sizes = []
    for scale in (1.0, 400.0):
        columns[names[0]][120] = scale
        path = tmp_path / "weights.parquet"
        head = weights.head_columns(still, still)
        weights.write(path, tmp_path / "w.csv", np.arange(200), columns | head, RATE)
        words = take.bake_options()
        words[words.index("--weights") + 1] = str(path)
        bake_mesh.main(words)
        render_preview.main(mesh_options(take))
        right = pictures(take)[5][1][: preview.HEIGHT, -preview.HEIGHT :].astype(int)
        sizes.append((np.ptp(right, axis=2) > 24).mean())
    assert sizes[0] > 0.2
    assert abs(sizes[1] - sizes[0]) < 0.02
    bake_mesh.main(take.bake_options())


def test_another_rig_than_the_baked_one_is_refused(take, tmp_path):
    other = SmallTake(tmp_path, size=11.0)
    assemble_rig.main(other.rig_options())
    line = mesh_options(take)
    line[line.index("--rig") + 1] = f"{tmp_path}/rig.npz"
    with pytest.raises(errors.InputError, match=r"mesh\.json: is not baked from"):
        render_preview.main(line)


def test_curves_run_beside_the_film(take):
    time = np.arange(FRAMES) / 30
    curves = {"jaw": np.sin(9 * time), "lid": time}
    path = take.folder / "controls.parquet"
    series.write(path, "controls", np.arange(FRAMES), time, curves, RATE)
    render_controls.main(options(take, controls=path.name))
    shown = pictures(take)
    assert len(shown) == FRAMES
    right = [picture[: preview.HEIGHT, -preview.HEIGHT :].astype(int) for _, picture in shown]
    orange = [np.clip(p[:, :, 0] - p[:, :, 2], 0, None).sum(axis=0) for p in right]
    assert (np.diff([columns.argmax() for columns in orange]) > 0).all()


def write_markers(take, seconds):
    rng = np.random.default_rng(3)
    count = round(120 * seconds)
    points = np.tile(rng.normal(size=(20, 3)) * [40, 60, 30], (count, 1, 1))
    points[:, 0, 1] += np.linspace(0, 30, count)
    names = [f"m{index}" for index in range(20)]
    columns = series.unstack(points, names, "xyz")
    columns |= {f"{name}.repaired": np.zeros(count) for name in names}
    columns["m5.repaired"] = np.where(np.arange(count) < count / 2, 2.0, 0.0)
    columns["confidence"] = columns["markers.confidence"] = np.full(count, 0.95)
    path = take.folder / "performance.parquet"
    time = np.arange(count) / 120
    series.write(path, "performance", np.arange(count), time, columns, Fraction(120))
    return str(path)


def marker_options(take, video):
    line = mesh_options(take)
    line[line.index("--video") + 1] = video
    line[line.index("--tracked") : line.index("--tracked") + 2] = []
    return [*line, "--performance", write_markers(take, FRAMES / 30)]


def orange(picture):
    red, blue = picture[: preview.HEIGHT, :, 0].astype(int), picture[: preview.HEIGHT, :, 2]
    return (red - blue > 90).sum()


def test_markers_alone_are_shown_at_a_rate_that_a_player_can_take(take):
    render_preview.main(marker_options(take, ""))
    shown = pictures(take)
    assert len(shown) == FRAMES
    np.testing.assert_allclose([time for time, _ in shown], np.arange(FRAMES) / 30, atol=1e-3)
    panels = [picture[:, : marker_panel.WIDTH] for _, picture in shown]
    assert panels[0].shape[1] + preview.HEIGHT == shown[0][1].shape[1]
    assert orange(panels[0]) > 10 > orange(panels[-1])


def test_a_film_that_is_not_tracked_stands_beside_its_markers(take):
    render_preview.main(marker_options(take, f"{take.folder}/film.mp4"))
    shown = pictures(take)
    width = preview.film_width(128, 96)
    assert len(shown) == FRAMES
    assert shown[0][1].shape[1] == width + marker_panel.WIDTH + preview.HEIGHT
    assert np.abs(shown[3][1][: preview.HEIGHT, :width].astype(int) - 90).max() < 30
    assert orange(shown[0][1][:, width : width + marker_panel.WIDTH]) > 10


def test_where_both_drive_a_take_contours_and_markers_show_and_the_worse_warns(take):
    render_preview.main([*mesh_options(take), "--performance", write_markers(take, FRAMES / 30)])
    shown = pictures(take)
    width = preview.film_width(128, 96)
    assert shown[0][1].shape[1] == width + marker_panel.WIDTH + preview.HEIGHT
    films = [picture[: preview.HEIGHT, :width].astype(int) for _, picture in shown]
    assert np.abs(films[3] - 90).max() > 60
    assert orange(shown[0][1][:, width : width + marker_panel.WIDTH]) > 10
    # the film's points were lost on the first frame, the markers never
    strips = [picture[preview.HEIGHT :, -120:].astype(int) for _, picture in shown]
    warns = [(strip[..., 0] - strip[..., 2] > 60).any() for strip in strips]
    assert warns == [True] + [False] * (FRAMES - 1)
