"""From marker takes and picked extremes to takes in layers, and what is refused on the way."""

import re
import shutil

import conftest
import layer_show
import numpy as np
import pytest

from stages.files import series

TAKE = {"preview.mp4", "mesh.exr", "mesh.json", "mesh.pc2", "mesh.glb", "weights.csv"}
SOLVED = {"layers.parquet", "directed.parquet", "weights.parquet"}
# what follows a change of a take's layers, up to what is looked at
SHOWN = {"smooth_weights": 1, "export_layers": 1, "bake_mesh": 1, "render_preview": 1}
DELIVERED = {"project_blendshapes": 1, "delivery_livelink": 1}


@pytest.fixture(scope="module")
def layered(tmp_path_factory):
    """Return a show of layers that has been run once; tests copy it before they change it."""
    folder = tmp_path_factory.mktemp("layered")
    show = conftest.Show(folder / "show", conftest.checkout(folder / "checkout"))
    layer_show.build(show.folder)
    run = show.snakemake()
    assert run.returncode == 0, run.stdout + run.stderr
    return show


@pytest.fixture
def show(layered, tmp_path):
    """Return a finished show that a test may change."""
    return layered.copy(tmp_path / "show")


def edit(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def add(path, *cells):
    with path.open("a") as table:
        table.write("\t".join(map(str, cells)) + "\n")


def take(show, character):
    return show.folder / "results/takes/b" / character


def names_in(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*")}


def read_pc2(path):
    """Return the vertices (T, V, 3) of a point cache."""
    raw = path.read_bytes()
    count, samples = (int.from_bytes(raw[at : at + 4], "little") for at in (16, 28))
    return np.frombuffer(raw, "<f4", offset=32).reshape(samples, count, 3)


def columns(path, kind):
    """Return a series and its columns of rig names, as (mask, (layer, name)) -> curve."""
    found = series.read(path, kind)
    curves = {}
    for name, curve in found.columns.items():
        mask, _, extreme = name.partition(".")
        if mask in layer_show.MASKS:
            curves[mask, tuple(extreme.split("_"))] = curve
    return found, curves


def test_a_run_delivers_everything_and_a_second_does_nothing(layered):
    curves = {f"layers/{layer}.csv" for layer in layer_show.LAYERS}
    plain, painted = (names_in(take(layered, name)) for name in ("plain", "painted"))
    assert plain > TAKE | SOLVED | curves
    assert not {name for name in plain if name.startswith(("delivery", "shaped", "sound"))}
    assert painted > TAKE | SOLVED | curves | {"shaped.parquet", "shaped_head.parquet"}
    assert painted > {"delivery.parquet", "delivery.csv", "delivery/livelink.csv", "sound.flac"}
    cast = layered.folder / "results/cast/eve"
    for name in ("plain", "painted"):
        assert names_in(cast / name) > {"rig.npz", "poses.parquet", "simplices.npz"}
    assert (cast / "painted/dynamics.npz").is_file()
    proposals = layered.folder / "results/actors/eve/expressions"
    assert names_in(proposals) == {"index.html", "expressions.tsv"}
    # extremes are proposed for a cast only
    assert not (layered.folder / "results/actors/lea").exists()
    second = layered.snakemake()
    assert second.returncode == 0
    assert "Nothing to be done" in second.stdout + second.stderr


def test_the_composed_mesh_is_the_planted_one(layered):
    """Where markers were seen and no prior asks for else, it is within 0.5 % of the motion."""
    mesh = read_pc2(take(layered, "plain") / "mesh.pc2")
    time_s = series.read(take(layered, "plain") / "weights.parquet", "weights").time_s
    motion = layer_show.composed(layer_show.mixture(time_s), layer_show.poses(2, 2.0))
    error = mesh - layer_show.neutral(2.0, 0.1) - motion
    lost = slice(*layer_show.LOST)
    size, error = (np.sqrt(np.mean(each**2, axis=(1, 2))) for each in (motion, error))
    seen = np.delete(error, np.r_[lost])
    assert len(seen) == len(time_s) - 6
    assert seen.max() < 0.005 * np.sqrt(np.mean(size**2))
    # what was lost is bridged
    assert error[lost].max() < 0.4 * size[lost].mean()


def test_a_character_moves_by_its_nature(layered):
    directed, found = columns(take(layered, "painted") / "directed.parquet", "directed")
    assert {extreme for _, extreme in found} == set(layer_show.POSES)
    for curve in found.values():
        assert np.flatnonzero(np.isnan(curve)).tolist() == list(range(*layer_show.LOST))
    played, found = columns(take(layered, "painted") / "weights.parquet", "weights")
    # twice as fast, without a gap, and its head does not turn to the sides
    assert played.time_s[-1] == pytest.approx(directed.time_s[-1] / 2, abs=1 / 15)
    assert np.isfinite(list(played.columns.values())).all()
    np.testing.assert_allclose(played.columns["head.rotation.w"], 1, atol=1e-6)
    planted = layer_show.mixture(2 * played.time_s)[:, layer_show.MASKS.index("mouth")]
    planted = dict(zip(layer_show.EXTREMES, planted.T, strict=True))
    lost = np.array(layer_show.LOST) / layer_show.RATE
    seen = abs(2 * played.time_s - lost.mean()) > np.ptp(lost)
    # speech stays with the sound, emotion comes after; frames cling a little to those before
    for extreme in (("speech", "m"), ("speech", "aa")):
        error = (found["mouth", extreme] - planted[extreme])[seen]
        assert np.sqrt(np.mean(error**2)) < 0.1 * planted[extreme].max()
    rising = np.flatnonzero(np.diff(planted["emotion", "joy"]) > 0)
    joy = found["mouth", ("emotion", "joy")]
    assert (joy[rising] <= planted["emotion", "joy"][rising]).all() and joy[rising].max() > 0.01


def test_delivery_is_the_take_on_the_artists_shapes(layered):
    _, played = columns(take(layered, "painted") / "weights.parquet", "weights")
    delivered = series.read(take(layered, "painted") / "delivery.parquet", "weights")
    high = {"eyeBlinkLeft": layer_show.MOST_BLINK}
    rows = (take(layered, "painted") / "delivery/livelink.csv").read_text().splitlines()
    header = rows[0].split(",")
    for shape, places in layer_show.SHAPES.items():
        row = places[0][1]
        mask = "mouth" if row < 3 else "eyes" if row in (4, 5) else "upper"
        mixed = np.zeros(len(delivered.frame))
        for extreme, mix in layer_show.POSES.items():
            if shape in mix and (mask, extreme) in played:
                mixed += mix[shape] * played[mask, extreme]
        assert mixed.max() > 0.02 or shape == "browDownLeft"
        expected = np.clip(mixed, 0, high.get(shape, 1))
        found = delivered.columns[f"face.{shape}"]
        np.testing.assert_allclose(found, expected, atol=1e-6)
        at = header.index(shape[0].upper() + shape[1:])
        curve = [float(line.split(",")[at]) for line in rows[1:]]
        np.testing.assert_allclose(curve, found, atol=1e-4)
    assert delivered.columns["face.eyeBlinkLeft"].max() == pytest.approx(layer_show.MOST_BLINK)


def test_a_pose_that_is_missing_is_reported(layered):
    table = layered.folder / "results/cast/eve/painted/simplices.tsv"
    rows = [line.split("\t") for line in table.read_text().splitlines()[1:]]
    unused = [row[:3] for row in rows if row[2] != "used"]
    assert unused == [[*layer_show.MISSING, "missing on the character"]]
    assert len(rows) == len(layer_show.EXTREMES) + len(layer_show.RESTS)
    page = (layered.folder / "results/report/index.html").read_text()
    assert "missing on the character: emotion rage" in page
    assert "2 of 2 takes are finished" in page


def edit_pose(show):
    pose = show.folder / "plain/poses/blink_half.obj"
    edit(pose, "v 0.0", "v 0.1")


def direct(show, character, shot):
    add(show.folder / "config/directing.tsv", character, shot, "emotion", "anger", 0.5, "", "", 0.2)


def pick(show, actor):
    shot = {"eve": "a", "lea": "c"}[actor]
    frame = layer_show.PEAKS["speech", "aa"]
    row = f"{actor}\tspeech\taa\t{shot}\t"
    edit(show.folder / "config/expressions.tsv", f"{row}{frame}", f"{row}{frame - 1}")


DIRECTED = {"direct_layers": 1, **SHOWN}
# dynamics are learnt from what a character does in the basis shot
PICKED = {
    "assemble_simplices": 2,
    "transfer_layers": 3,
    "direct_layers": 3,
    "learn_dynamics": 1,
    "shape_motion": 1,
    **dict.fromkeys(SHOWN, 2),
    **DELIVERED,
}


@pytest.mark.parametrize(
    ("change", "made"),
    [
        (
            lambda show: (edit_pose(show), pick(show, "lea")),
            DIRECTED | {"assemble_poses": 1, "assemble_simplices": 1, "transfer_layers": 1},
        ),
        # the take `a` of this character is not mentioned, nor is the other character
        (
            lambda show: direct(show, "painted", "b"),
            DIRECTED | DELIVERED | {"shape_motion": 1},
        ),
        (lambda show: pick(show, "eve"), PICKED),
    ],
    ids=["pose and another actor", "directed take", "picked"],
)
def test_a_change_makes_only_what_depends_on_it_again(show, change, made):
    change(show)
    assert show.would_run() == made


def faulty_show(show):
    """Add two characters with faulty masks, misdirect a third, and lose a file of the one left."""
    shutil.copytree(show.folder / "painted", show.folder / "black")
    paint = show.folder / "black/masks.ply"
    paint.write_text(re.sub(r" \d+ 0 0\n", " 0 0 0\n", paint.read_text(), count=1))
    shutil.copytree(show.folder / "plain", show.folder / "unsummed")
    edit(show.folder / "unsummed/masks.tsv", "\n3\tmouth\t0.5\n", "\n3\tmouth\t0.7\n")
    characters = show.folder / "config/characters.tsv"
    lines = characters.read_text().splitlines()
    for old, new in (("plain", "unsummed"), ("painted", "black")):
        row = next(line for line in lines if line.startswith(old))
        add(characters, row.replace(f"\t{old}\t", f"\t{new}\t").replace(old, new, 1))
        add(show.folder / "config/cast.tsv", "eve", new, "markers", "b")
    add(show.folder / "config/directing.tsv", "painted", "b", "emotion", "angre", 2, "", "", 0.2)
    for name in ("preview.mp4", "layers/speech.csv"):
        (take(show, "plain") / name).unlink()


FAULTS = {
    "assemble_poses/eve/black": r"black/masks\.ply: vertex 6 is black, .*: paint it red, .*",
    "assemble_poses/eve/unsummed": r"unsummed/masks\.tsv: vertex 3: .*1\.2.*: correct its rows",
    "direct_layers/b/painted": r"config/directing\.tsv: line 2, column name: emotion has no 'angre'"
    r", is it anger\?: correct it, or .*",
}


def test_faulty_characters_leave_the_others_their_takes(show):
    faulty_show(show)
    run = show.snakemake()
    assert run.returncode == 1
    assert "Traceback" not in run.stderr
    page = (show.folder / "results/report/index.html").read_text()
    for place, pattern in FAULTS.items():
        log = (show.folder / f"logs/{place}.log").read_text()
        lines = log.splitlines()
        assert len(lines) == 1 and re.fullmatch(f"error: {pattern}", lines[0]), log
        assert lines[0].split(":")[1].strip() in page
    assert names_in(take(show, "plain")) > TAKE | SOLVED | {"layers/speech.csv"}
    assert not (show.folder / "results/cast/eve/black/rig.npz").exists()
    assert not (show.folder / "results/cast/eve/unsummed/rig.npz").exists()


def without(*starts):
    """Return a function that takes rows out of a table."""

    def take_out(text):
        kept = [line for line in text.splitlines(True) if not line.startswith(starts)]
        assert len(kept) < text.count("\n")
        return "".join(kept)

    return take_out


@pytest.mark.parametrize(
    ("change", "pattern"),
    [
        (
            without("eve\tblink\topen", "eve\tblink\thalf"),
            r"line 9: closed is the one extreme of layer blink: pick a second, such as open, .*",
        ),
        (
            lambda text: text.replace("eve\temotion\tsurprise", "eve\temotion\tsurprize"),
            r"line 6, column name: emotion has no extreme 'surprize', the nearest is surprise: .*",
        ),
        (
            without("eve\tspeech\tm\t"),
            r"eve has no row for speech m, the closed lips: add it, or set lip_sigma to 0 .*",
        ),
    ],
    ids=["one extreme", "unknown name", "no closed lips"],
)
def test_faulty_picks_are_named(show, change, pattern):
    table = show.folder / "config/expressions.tsv"
    table.write_text(change(table.read_text()))
    target = "results/cast/eve/painted/simplices.npz"
    assert show.snakemake(target).returncode == 1
    log = (show.folder / "logs/assemble_simplices/eve/painted.log").read_text()
    assert re.fullmatch(rf"error: config/expressions\.tsv: {pattern}\n", log), log
    assert not (show.folder / target).exists()


SENSELESS = [
    (
        "cast",
        "eve\tplain\tmarkers",
        "eve\tplain\tboth",
        r"config/cast\.tsv: line 2, column points: b has no both points",
    ),
    (
        "characters",
        "\t0\t0\t0\tnone\t\t\t",
        "\t0\t0\t0\tnone\t\t\tchannels.tsv",
        r"config/characters\.tsv: line 2, column channels: method layers has channels of its "
        r"delivery_shapes alone; clear the cell",
    ),
    (
        "characters",
        "\t2\tdynamics",
        "\t0\tdynamics",
        r"config/characters\.tsv: line 3, column tempo: must be above 0; write 1 for no change",
    ),
]


@pytest.mark.parametrize(
    ("table", "old", "new", "pattern"), SENSELESS, ids=["both", "channels", "tempo"]
)
def test_tables_that_make_no_sense_stop_before_any_job(show, table, old, new, pattern):
    edit(show.folder / "config" / f"{table}.tsv", old, new)
    run = show.snakemake()
    lines = [line for line in run.stderr.splitlines() if line.startswith("error: ")]
    assert run.returncode == 1 and len(lines) == 1, run.stderr
    assert re.match(f"error: {pattern}", lines[0]), lines[0]
    assert "Traceback" not in run.stderr


def test_extremes_are_proposed_before_there_is_any_table(show):
    for name in ("expressions", "actor_masks", "directing"):
        (show.folder / f"config/{name}.tsv").unlink()
    for name in ("cast", "takes", "actors"):
        shutil.rmtree(show.folder / "results" / name)
    assert show.snakemake().returncode == 1
    proposals = show.folder / "results/actors/eve/expressions"
    assert names_in(proposals) == {"index.html", "expressions.tsv"}
    log = (show.folder / "logs/assemble_simplices/eve/plain.log").read_text()
    assert re.fullmatch(r"error: config/expressions\.tsv: no such .*\n", log), log
