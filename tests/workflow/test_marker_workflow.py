"""From marker takes and tuned pairs to finished takes of a rig, and what is refused on the way."""

import re
import shutil

import conftest
import marker_show
import numpy as np
import pygltflib as gltf
import pytest

from stages.core import local_shapes
from stages.files import rig, series

FOLLOWS = {"smooth_weights": 2, "bake_mesh": 2, "render_preview": 2}
SOLUTIONS = {"tuned": "predicted", "solved": "solved"}


@pytest.fixture(scope="module")
def marked(tmp_path_factory):
    """Return a show of markers that has been run once; tests copy it before they change it."""
    folder = tmp_path_factory.mktemp("marked")
    show = conftest.Show(folder / "show", conftest.checkout(folder / "checkout"))
    marker_show.build(show.folder)
    run = show.snakemake()
    assert run.returncode == 0, run.stdout + run.stderr
    return show


@pytest.fixture
def show(marked, tmp_path):
    """Return a finished show that a test may change."""
    return marked.copy(tmp_path / "show")


def edit(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def test_a_run_delivers_everything_and_a_second_does_nothing(marked):
    results = marked.folder / "results"
    for shot in "ab":
        for character, solution in SOLUTIONS.items():
            take = results / "takes" / shot / character
            names = {"mesh.exr", "mesh.json", "mesh.pc2", "mesh.glb", "preview.mp4", "weights.csv"}
            assert names < {path.name for path in take.iterdir()}
            assert (take / f"{solution}.parquet").is_file()
    references = results / "cast/eve/tuned/references"
    assert (references / "index.html").is_file()
    header = (references / "pairs.tsv").read_text().splitlines()[0].split("\t")
    assert header == ["shot", "frame", *marker_show.SHAPES]
    assert "5 of 5 takes are finished" in (results / "report/index.html").read_text()
    second = marked.snakemake()
    assert second.returncode == 0
    assert "Nothing to be done" in second.stdout + second.stderr


@pytest.mark.parametrize("character", SOLUTIONS)
@pytest.mark.parametrize("shot", "ab")
def test_weights_follow_the_planted_ones(marked, shot, character):
    take = marked.folder / "results/takes" / shot / character
    found = series.read(take / f"{SOLUTIONS[character]}.parquet", SOLUTIONS[character])
    expected = marker_show.weights(shot, found.time_s)
    weights = np.stack([found.columns[f"face.{name}"] for name in marker_show.SHAPES], axis=1)
    assert found.rate == marker_show.RATE
    assert np.sqrt(np.mean((weights - expected) ** 2, axis=0)).max() < 0.02
    # what is delivered has the character's own rate
    played = series.read(take / "weights.parquet", "weights")
    expected = marker_show.weights(shot, played.time_s)
    weights = np.stack([played.columns[f"face.{name}"] for name in marker_show.SHAPES], axis=1)
    assert played.rate == marker_show.FILM_RATE
    assert np.sqrt(np.mean((weights - expected) ** 2, axis=0)).max() < 0.05


def test_recorded_curves_drive_the_same_rig(marked, tmp_path):
    recorded = marker_show.write_live_link(tmp_path / "phone.csv")
    take = marked.folder / "results/takes/phone/tuned"
    assert (take / "preview.mp4").is_file()
    found = series.read(take / "mapped.parquet", "mapped")
    for name, curve in zip(marker_show.SHAPES, recorded.T, strict=True):
        np.testing.assert_allclose(found.columns[f"face.{name}"], curve, atol=1e-6)


def test_an_edited_pair_makes_only_its_character_again(show):
    pairs = show.folder / "plate/pairs/ann.tsv"
    cells = pairs.read_text().splitlines()[5].split("\t")
    edit(pairs, "\t".join(cells), "\t".join([*cells[:-1], "0.5"]))
    made = {"train_rbf": 1, "select_references": 1, "write_references": 1, "predict_weights": 2}
    assert show.would_run() == made | FOLLOWS


def test_the_page_of_references_needs_no_pairs(show):
    shutil.rmtree(show.folder / "plate/pairs")
    references = show.folder / "results/cast/eve/tuned/references"
    shutil.rmtree(references)
    assert show.snakemake(str(references.relative_to(show.folder) / "index.html")).returncode == 0
    rows = [line.split("\t") for line in (references / "pairs.tsv").read_text().splitlines()[1:]]
    assert len(rows) == int(marker_show.REFERENCES)
    assert {row[0] for row in rows} == {"a"}


def test_a_lost_marker_file_fails_its_shot_and_leaves_the_rest(show):
    (show.folder / "footage/b.csv").unlink()
    preview = show.folder / "results/takes/a/tuned/preview.mp4"
    preview.unlink()
    assert show.snakemake().returncode == 1
    log = (show.folder / "logs/import_markers/b.log").read_text()
    assert re.fullmatch(r"error: footage/b\.csv: no such .*\n", log)
    assert preview.is_file()
    assert not (show.folder / "results/shots/b/markers.parquet").exists()
    report = (show.folder / "results/report/index.html").read_text()
    assert "footage/b.csv: no such" in report


def test_the_sound_of_another_take_is_refused_and_a_cell_cures_it(show):
    shots, performance = show.folder / "config/shots.tsv", "results/shots/a/performance.parquet"
    measured = series.read(show.folder / performance, "performance")
    edit(shots, "footage/a.wav\t", "footage/b.wav\t")
    assert show.snakemake(performance).returncode == 1
    log = (show.folder / "logs/merge_capture/a.log").read_text()
    assert re.fullmatch(
        r"error: results/shots/a/sync\.json: markers and film are not in step "
        r"\(no common sound found\): set sync_offset_s in shots\.tsv\n",
        log,
    )
    edit(shots, "footage/b.wav\t", f"footage/b.wav\t{-marker_show.AHEAD_S}")
    assert show.snakemake(performance).returncode == 0
    given = series.read(show.folder / performance, "performance")
    assert given.columns.keys() == measured.columns.keys()
    for axis in "xyz":
        name = f"M00.{axis}"
        np.testing.assert_allclose(given.columns[name], measured.columns[name], atol=0.1)


def test_a_shot_of_another_actor_trains_nobody_again(show):
    edit(
        show.folder / "config/shots.tsv",
        "phone\ts2",
        "again\ts2\t\t\t\t\tfootage/phone.csv\t\nphone\ts2",
    )
    planned = show.would_run()
    assert planned["import_curves"] == 1
    assert not {"train_rbf", "select_references", "predict_weights"} & set(planned)


def write_glb(path):
    """Write the plate and its shapes as one file."""
    neutral, shapes = marker_show.plate()
    arrays = [array.astype("<f4") for array in (neutral, *shapes)]
    size, count = arrays[0].nbytes, len(arrays)
    document = gltf.GLTF2(
        meshes=[
            gltf.Mesh(
                primitives=[
                    gltf.Primitive(
                        attributes=gltf.Attributes(POSITION=0),
                        targets=[{"POSITION": number} for number in range(1, count)],
                    )
                ],
                extras={"targetNames": list(marker_show.SHAPES)},
            )
        ],
        accessors=[
            gltf.Accessor(bufferView=number, componentType=5126, count=len(neutral), type="VEC3")
            for number in range(count)
        ],
        bufferViews=[
            gltf.BufferView(buffer=0, byteOffset=number * size, byteLength=size)
            for number in range(count)
        ],
        buffers=[gltf.Buffer(byteLength=count * size)],
    )
    document.set_binary_blob(b"".join(array.tobytes() for array in arrays))
    document.save_binary(str(path))


def test_a_rig_in_one_file_does_what_a_folder_of_shapes_does(show):
    checks = "results/cast/eve/solved/rig_checks.tsv"
    before = rig.read(show.folder / "results/cast/eve/solved/rig.npz", "mesh")
    table = (show.folder / checks).read_text()
    write_glb(show.folder / "plate/neutral.glb")
    row = "solved\tblendshapes\tplate\tneutral"
    edit(show.folder / "config/characters.tsv", f"{row}.obj", f"{row}.glb")
    shutil.rmtree(show.folder / "results/cast/eve/solved")
    solved = "results/takes/b/solved/solved.parquet"
    run = show.snakemake(checks, solved)
    assert run.returncode == 0, run.stderr
    after = rig.read(show.folder / "results/cast/eve/solved/rig.npz", "mesh")
    assert after.names == before.names
    np.testing.assert_allclose(
        local_shapes.dense(after.deltas), local_shapes.dense(before.deltas), atol=1e-5
    )
    assert (show.folder / checks).read_text() == table
    found = series.read(show.folder / solved, "solved")
    weights = np.stack([found.columns[f"face.{name}"] for name in marker_show.SHAPES], axis=1)
    expected = marker_show.weights("b", found.time_s)
    assert np.sqrt(np.mean((weights - expected) ** 2, axis=0)).max() < 0.02


SENSELESS = [
    (
        "characters",
        "solved\tblendshapes\tplate\tneutral.obj\t\t",
        "solved\tkey_shapes\tplate\tneutral.glb\tmasks.tsv\t",
        r"config/characters\.tsv: line 3, column neutral: this method needs an \.obj",
    ),
    (
        "characters",
        "solved\tblendshapes\tplate\tneutral.obj\t\t",
        "solved\tkey_shapes\tplate\tneutral.obj\tmasks.tsv\t",
        r"config/cast\.tsv: line 3, column points: method key_shapes is driven by video; write",
    ),
    (
        "shots",
        "\tfootage/a.wav",
        "\t",
        r"config/shots\.tsv: line 2, column sound: film and markers share no clock",
    ),
    (
        "shots",
        "footage/a.csv\tfootage/a.wav",
        "\tfootage/a.wav",
        r"config/shots\.tsv: line 2, column sound: is the marker system's, yet the film has no",
    ),
    (
        "sessions",
        "eve\ta\t",
        "eve\tphone\t",
        r"config/sessions\.tsv: line 2, column neutral_shot: 'phone' shows lea, not eve",
    ),
    (
        "sessions",
        "M30,M34",
        "",
        r"config/sessions\.tsv: line 2, column unit_markers: is blank, yet its shots have markers",
    ),
    (
        "cast",
        "eve\ttuned\tmarkers",
        "eve\ttuned\tvideo",
        r"config/cast\.tsv: line 2, column points: any shot of this actor has no video points",
    ),
    (
        "cast",
        "solved\tmarkers\t",
        "solved\tmarkers\tb,phone",
        r"config/cast\.tsv: line 3, column points: phone has no markers points",
    ),
]


@pytest.mark.parametrize(("table", "old", "new", "pattern"), SENSELESS)
def test_tables_that_make_no_sense_stop_before_any_job(show, table, old, new, pattern):
    edit(show.folder / "config" / f"{table}.tsv", old, new)
    run = show.snakemake()
    lines = [line for line in run.stderr.splitlines() if line.startswith("error: ")]
    assert run.returncode == 1 and len(lines) == 1, run.stderr
    assert re.match(f"error: {pattern}", lines[0]), lines[0]
    assert "Traceback" not in run.stderr


def test_a_pair_of_an_unknown_shot_is_named(show):
    edit(show.folder / "plate/pairs/ann.tsv", "\na\t33\t", "\nz\t33\t")
    assert show.snakemake("results/cast/eve/tuned/rbf.npz").returncode == 1
    log = (show.folder / "logs/train_rbf/eve/tuned.log").read_text()
    assert re.fullmatch(r"error: plate/pairs/ann\.tsv: line 3, column shot: .*'z'.*\n", log), log
