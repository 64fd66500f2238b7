from fractions import Fraction

import numpy as np
import pytest
from small_take import changed_by, words, write_obj

from stages import assemble_blendshapes, assemble_poses, bake_mesh, project_blendshapes
from stages.files import errors, rig, series, weights

RATE = Fraction(24)
FRAMES = 10
FACE_UNIT = 6.5
FACES = [(0, 1, 2), (1, 3, 2), (2, 3, 4)]
NEUTRAL = np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0], [4, 4, 1], [2, 8, 0]])
SHAPES = {
    "jawOpen": [[0, -1, 0], [0, -2, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]],
    "smile": [[-1, 0.5, 0], [1, 0.5, 0.5], [0, 0, 0], [0, 0, 0], [0, 0, 0]],
    "browUp": [[0, 0, 0], [0, 0, 0], [0, 1, 0], [0, 1, 0], [0, 2, 0]],
}
# poses as mixtures of the shapes; so what is laid on them is known
MIXES = {"emotion_joy": {"smile": 1.0, "browUp": 0.4}, "speech_aa": {"jawOpen": 0.8}}


class Delivered:
    """A folder with a rig of layers, the artist's shapes, and a take."""

    def __init__(self, folder, seen=lambda vertices: vertices):
        self.folder = folder
        write_obj(folder / "neutral.obj", NEUTRAL, FACES)
        write_obj(folder / "own" / "neutral.obj", seen(NEUTRAL), FACES)
        for name, delta in SHAPES.items():
            write_obj(folder / "shapes" / f"{name}.obj", NEUTRAL + np.array(delta), FACES)
            write_obj(folder / "own" / f"{name}.obj", seen(NEUTRAL + np.array(delta)), FACES)
        (folder / "poses").mkdir()
        for name, mix in MIXES.items():
            rows = "".join(f"{shape},{value}\n" for shape, value in mix.items())
            (folder / "poses" / f"{name}.csv").write_text("name,value\n" + rows)
        (folder / "masks.tsv").write_text("region\taxis\tfrom\tto\nface\t\t\t\n")
        common = {"unit": "cm", "up-axis": "y", "pivot": "0 -1 2", "face-unit": f"{FACE_UNIT}"}
        options = common | {"neutral": f"{folder}/neutral.obj", "pose-folder": f"{folder}/poses"}
        options |= {"masks": f"{folder}/masks.tsv", "painted-masks": ""}
        options |= {"extremes": "stages/tables/extremes.tsv", "rig": f"{folder}/rig.npz"}
        options |= {"poses-table": f"{folder}/poses.parquet"}
        given = ["--poses", *sorted(map(str, (folder / "poses").iterdir()))]
        given += ["--shapes", *sorted(map(str, (folder / "shapes").iterdir()))]
        assemble_poses.main([*words(options), *given])
        options = common | {"neutral": f"{folder}/own/neutral.obj", "shape-folder": "own"}
        options |= {"rig": f"{folder}/delivery_rig.npz"}
        shapes = [f"{folder}/own/{name}.obj" for name in SHAPES]
        assemble_blendshapes.main([*words(options), "--shapes", *shapes])
        self.perform()

    def perform(self):
        rng = np.random.default_rng(4)
        self.curves = {
            "face.emotion_joy": rng.uniform(0, 0.9, FRAMES),
            "face.speech_aa": rng.uniform(0, 0.9, FRAMES),
        }
        turns = rng.normal(size=(FRAMES, 4)) + np.array([0, 0, 0, 6])
        turns /= np.linalg.norm(turns, axis=1, keepdims=True)
        rest = np.c_[rng.normal(size=(FRAMES, 3)), np.full(FRAMES, 1.1)]
        columns = self.curves | weights.head_columns(turns, rest)
        columns |= {"confidence": rng.uniform(size=FRAMES)}
        meta = {"start_timecode": "10:00:00:00", "timecode_rate": "24"}
        paths = self.folder / "weights.parquet", self.folder / "weights.csv"
        weights.write(*paths, np.arange(7, 7 + FRAMES), columns, RATE, meta)

    def project(self, **changed):
        folder = self.folder
        options = {
            "rig": f"{folder}/rig.npz",
            "weights": f"{folder}/weights.parquet",
            "delivery-rig": f"{folder}/delivery_rig.npz",
            "channels": "",
            "delivery": f"{folder}/delivery.parquet",
            "csv": f"{folder}/delivery.csv",
        } | changed_by(changed)
        project_blendshapes.main(words(options))
        return series.read(folder / "delivery.parquet", "weights")


def baked(folder, rig_name, weights_name):
    """Return the vertices of every frame, as a bake writes them."""
    options = {"rig": f"{folder}/{rig_name}", "weights": f"{folder}/{weights_name}"}
    options |= {kind: f"{folder}/{weights_name}.{kind}" for kind in ("exr", "json", "pc2", "glb")}
    bake_mesh.main(words(options))
    data = (folder / f"{weights_name}.pc2").read_bytes()[32:]
    return np.frombuffer(data, "<f4").reshape(FRAMES, len(NEUTRAL), 3)


def test_the_delivery_bakes_to_the_same_film(tmp_path):
    take = Delivered(tmp_path)
    found = take.project()
    for shape in SHAPES:
        expected = sum(
            mix.get(shape, 0.0) * take.curves[f"face.{pose}"] for pose, mix in MIXES.items()
        )
        np.testing.assert_allclose(found.columns[f"face.{shape}"], expected, atol=1e-6)
    assert found.columns["residual"].max() < 1e-6
    np.testing.assert_allclose(
        baked(tmp_path, "delivery_rig.npz", "delivery.parquet"),
        baked(tmp_path, "rig.npz", "weights.parquet"),
        atol=1e-5,
    )
    played = weights.read(tmp_path / "delivery.parquet", [f"face.{shape}" for shape in SHAPES])
    source = weights.read(tmp_path / "weights.parquet", list(take.curves))
    assert (played.first_timecode, played.rate) == (source.first_timecode, RATE)
    assert played.first_timecode == "10:00:00:07"
    for name in ("frame", "rotation", "translation", "scale", "confidence"):
        np.testing.assert_array_equal(getattr(played, name), getattr(source, name))


def test_limits_hold_and_the_residual_is_what_they_leave(tmp_path):
    take = Delivered(tmp_path)
    table = tmp_path / "channels.tsv"
    table.write_text("shape\thigh\nbrowUp\t0\njawOpen\t0.3\n")
    found = take.project(channels=str(table)).columns
    assert found["face.browUp"].max() == 0.0
    assert found["face.jawOpen"].max() <= 0.3 + 1e-7
    masked = {name: np.array(delta) for name, delta in SHAPES.items()}
    for frame in range(FRAMES):
        face = sum(
            take.curves[f"face.{pose}"][frame] * value * masked[shape]
            for pose, mix in MIXES.items()
            for shape, value in mix.items()
        )
        laid = sum(found[f"face.{shape}"][frame] * masked[shape] for shape in SHAPES)
        distance = np.sqrt(np.mean(np.sum((face - laid) ** 2, axis=1))) / FACE_UNIT
        assert found["residual"][frame] == pytest.approx(distance, abs=1e-6)
    assert found["residual"].min() > 0.0


@pytest.mark.parametrize(
    ("seen", "message"),
    [
        (lambda vertices: vertices[[1, 0, 2, 3, 4]], "vertex 0 of its neutral is not where"),
        (lambda vertices: np.r_[vertices, [[9.0, 9, 9]]], "has 6 vertices, the character has 5"),
    ],
)
def test_rigs_of_other_vertices_are_refused(tmp_path, seen, message):
    take = Delivered(tmp_path, seen)
    with pytest.raises(errors.InputError, match=rf"delivery_rig\.npz: {message}"):
        take.project()
    assert not (tmp_path / "delivery.parquet").exists()


def test_another_unit_and_unknown_shapes_are_named(tmp_path):
    take = Delivered(tmp_path)
    other = rig.read(tmp_path / "delivery_rig.npz", "mesh")
    rig.write(tmp_path / "metres.npz", rig.Rig(**(vars(other) | {"unit": "m"})))
    with pytest.raises(errors.InputError, match=r"metres\.npz: is in m with y up, .*in cm"):
        take.project(delivery_rig=f"{tmp_path}/metres.npz")
    (tmp_path / "channels.tsv").write_text("shape\thigh\njawOpn\t0\n")
    with pytest.raises(errors.InputError, match=r"line 2, column shape: the rig has no .*'jawOpn'"):
        take.project(channels=f"{tmp_path}/channels.tsv")
