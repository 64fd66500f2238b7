"""From marker takes and picked extremes to takes in layers, and what a change makes again."""

import layer_face
import layer_show
import numpy as np
import pytest

from stages.files import series

# what follows a change of a take's layers, up to what is looked at
SHOWN = {"smooth_weights": 1, "export_layers": 1, "bake_mesh": 1, "render_preview": 1}
DELIVERED = {"project_blendshapes": 1, "delivery_livelink": 1}


@pytest.fixture
def show(layered, tmp_path):
    """Return a finished show that a test may change."""
    return layered.copy(tmp_path / "show")


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
        if mask in layer_face.MASKS:
            curves[mask, tuple(extreme.split("_"))] = curve
    return found, curves


def test_a_run_delivers_everything_and_a_second_does_nothing(layered):
    curves = {f"layers/{layer}.csv" for layer in layer_face.LAYERS}
    plain, painted = (
        layer_show.names_in(layer_show.take(layered, name)) for name in ("plain", "painted")
    )
    assert plain > layer_show.TAKE | layer_show.SOLVED | curves
    assert not {name for name in plain if name.startswith(("delivery", "shaped", "sound"))}
    assert painted > layer_show.TAKE | layer_show.SOLVED | curves | {
        "shaped.parquet",
        "shaped_head.parquet",
    }
    assert painted > {"delivery.parquet", "delivery.csv", "delivery/livelink.csv", "sound.flac"}
    cast = layered.folder / "results/cast/eve"
    for name in ("plain", "painted"):
        assert layer_show.names_in(cast / name) > {"rig.npz", "poses.parquet", "simplices.npz"}
    assert (cast / "painted/dynamics.npz").is_file()
    proposals = layered.folder / "results/actors/eve/expressions"
    assert layer_show.names_in(proposals) == {"index.html", "expressions.tsv"}
    # extremes are proposed for a cast only
    assert not (layered.folder / "results/actors/lea").exists()
    second = layered.snakemake()
    assert second.returncode == 0
    assert "Nothing to be done" in second.stdout + second.stderr


def test_the_composed_mesh_is_the_planted_one(layered):
    """Where markers were seen and no prior asks for else, it is within 0.5 % of the motion."""
    mesh = read_pc2(layer_show.take(layered, "plain") / "mesh.pc2")
    time_s = series.read(layer_show.take(layered, "plain") / "weights.parquet", "weights").time_s
    motion = layer_face.composed(layer_face.mixture(time_s), layer_face.poses(2, 2.0))
    error = mesh - layer_face.neutral(2.0, 0.1) - motion
    lost = slice(*layer_show.LOST)
    size, error = (np.sqrt(np.mean(each**2, axis=(1, 2))) for each in (motion, error))
    seen = np.delete(error, np.r_[lost])
    assert len(seen) == len(time_s) - 6
    assert seen.max() < 0.005 * np.sqrt(np.mean(size**2))
    # what was lost is bridged
    assert error[lost].max() < 0.4 * size[lost].mean()


def test_a_character_moves_by_its_nature(layered):
    directed, found = columns(layer_show.take(layered, "painted") / "directed.parquet", "directed")
    assert {extreme for _, extreme in found} == set(layer_show.POSES)
    for curve in found.values():
        assert np.flatnonzero(np.isnan(curve)).tolist() == list(range(*layer_show.LOST))
    played, found = columns(layer_show.take(layered, "painted") / "weights.parquet", "weights")
    # twice as fast, without a gap, and its head does not turn to the sides
    assert played.time_s[-1] == pytest.approx(directed.time_s[-1] / 2, abs=1 / 15)
    assert np.isfinite(list(played.columns.values())).all()
    np.testing.assert_allclose(played.columns["head.rotation.w"], 1, atol=1e-6)
    planted = layer_face.mixture(2 * played.time_s)[:, layer_face.MASKS.index("mouth")]
    planted = dict(zip(layer_face.EXTREMES, planted.T, strict=True))
    lost = np.array(layer_show.LOST) / layer_face.RATE
    seen = abs(2 * played.time_s - lost.mean()) > np.ptp(lost)
    # speech stays with the sound, emotion comes after; frames cling a little to those before
    for extreme in (("speech", "m"), ("speech", "aa")):
        error = (found["mouth", extreme] - planted[extreme])[seen]
        assert np.sqrt(np.mean(error**2)) < 0.1 * planted[extreme].max()
    rising = np.flatnonzero(np.diff(planted["emotion", "joy"]) > 0)
    joy = found["mouth", ("emotion", "joy")]
    assert (joy[rising] <= planted["emotion", "joy"][rising]).all() and joy[rising].max() > 0.05


def test_delivery_is_the_take_on_the_artists_shapes(layered):
    _, played = columns(layer_show.take(layered, "painted") / "weights.parquet", "weights")
    delivered = series.read(layer_show.take(layered, "painted") / "delivery.parquet", "weights")
    high = {"eyeBlinkLeft": layer_show.MOST_BLINK}
    rows = (layer_show.take(layered, "painted") / "delivery/livelink.csv").read_text().splitlines()
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
    assert len(rows) == len(layer_face.EXTREMES) + len(layer_face.RESTS)
    page = (layered.folder / "results/report/index.html").read_text()
    assert "missing on the character: emotion rage" in page
    assert "2 of 2 takes are finished" in page


def edit_pose(show):
    pose = show.folder / "plain/poses/blink_half.obj"
    layer_show.edit(pose, "v 0.0", "v 0.1")


def direct(show, character, shot):
    layer_show.add(
        show.folder / "config/directing.tsv", character, shot, "emotion", "anger", 0.5, "", "", 0.2
    )


def pick(show, actor):
    shot = {"eve": "a", "lea": "c"}[actor]
    frame = layer_face.PEAKS["speech", "aa"]
    row = f"{actor}\tspeech\taa\t{shot}\t"
    layer_show.edit(show.folder / "config/expressions.tsv", f"{row}{frame}", f"{row}{frame - 1}")


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
