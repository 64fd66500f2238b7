import logging
from fractions import Fraction

import numpy as np
import pytest

from stages import solve_blendshapes
from stages.core import head_transform, local_shapes
from stages.files import delimited, errors, rig, series

FRAMES, SHAPES, VERTICES = 40, ("jawOpen", "smile", "eyeBlink"), 30
PICKED = {f"m{i}": 3 * i for i in range(8)}
SCALE = np.array([1.2, 0.9, 0.8])


class Take:
    """A character, virtual markers on it, and an actor of other proportions, z up, in cm."""

    def __init__(self, folder, picture=False):
        rng = np.random.default_rng(0)
        face = rng.normal(size=(VERTICES, 3))
        deltas = 0.2 * rng.normal(size=(len(SHAPES), VERTICES, 3))
        time = np.arange(FRAMES) / 30
        phases = np.array([0.0, 1.0, 2.0])
        self.weights = 0.5 + 0.4 * np.sin(4 * time[:, None] + phases)
        self.folder = folder
        self.write_rig(face, deltas)
        delimited.write(
            folder / "virtual.tsv", ("point", "vertex"), [(n, str(v)) for n, v in PICKED.items()]
        )
        axes = 2 if picture else 3
        picked = list(PICKED.values())
        self.neutral = (face[picked] / SCALE)[:, :axes]
        moved = np.tensordot(self.weights, deltas[:, picked] / SCALE, axes=1)[:, :, :axes]
        self.points = self.neutral + moved
        self.kind = "video" if picture else "markers"

    def write_rig(self, face, deltas):
        axes = head_transform.face_axes("z")
        made = rig.Rig(
            names=[f"face.{shape}" for shape in SHAPES],
            mask_names=["face"],
            controls=[],
            neutral=6.5 * face @ axes.T,
            deltas=local_shapes.gather(6.5 * deltas @ axes.T),
            masks=np.ones((1, VERTICES)),
            mask_index=np.zeros(len(SHAPES), int),
            sizes=np.array([3]),
            corners=np.array([0, 1, 2]),
            colours=np.zeros((0, 3)),
            pivot=np.zeros(3),
            unit="cm",
            up_axis="z",
            face_unit=6.5,
        )
        rig.write(self.folder / "rig.npz", made)

    def solve(self, **changed):
        names = list(PICKED)
        axes = "xyz" if self.kind == "markers" else "xy"
        columns = series.unstack(self.points, names, axes)
        columns |= {"confidence": np.full(FRAMES, 0.9), "markers.confidence": np.full(FRAMES, 0.8)}
        named, rest = {
            "markers": ("markers", "marker_neutral"),
            "video": ("points", "neutral"),
        }[self.kind]
        meta = {"points": [], "neutral": [], named: names, rest: self.neutral.tolist()}
        frame = np.arange(FRAMES)
        path = self.folder / "expression.parquet"
        series.write(path, "expression", frame, frame / 30, columns, Fraction(30), meta)
        options = {
            "expression": path,
            "points": self.kind,
            "rig": self.folder / "rig.npz",
            "virtual-markers": self.folder / "virtual.tsv",
            "channels": "",
            "solve": "clip",
            "strength": 0.001,
            "solved": self.folder / "solved.parquet",
        } | {name.replace("_", "-"): value for name, value in changed.items()}
        solve_blendshapes.main([f"--{name}={value}" for name, value in options.items()])
        return series.read(self.folder / "solved.parquet", "solved")


@pytest.mark.parametrize("solve", ["positions", "displacements", "bounded", "clip"])
@pytest.mark.parametrize("picture", [False, True])
def test_weights_come_back_from_markers_and_from_a_film(tmp_path, solve, picture):
    take = Take(tmp_path, picture)
    solved = take.solve(solve=solve)
    found = np.stack([solved.columns[f"face.{shape}"] for shape in SHAPES], axis=1)
    np.testing.assert_allclose(found, take.weights, atol=2e-3)
    np.testing.assert_allclose(solved.columns["residual"], 0, atol=1e-3)
    assert np.max(solved.columns["kkt_residual"]) < 1e-4
    np.testing.assert_allclose(solved.columns["confidence"], 0.9 if picture else 0.8, rtol=1e-6)
    assert solved.rate == 30


def test_frames_without_points_have_no_weights_and_no_confidence(tmp_path):
    take = Take(tmp_path)
    take.points[5] = np.nan
    take.points[9, 0] = np.nan
    solved = take.solve()
    lost = np.arange(FRAMES) == 5
    for column in (*(f"face.{shape}" for shape in SHAPES), "residual", "kkt_residual"):
        np.testing.assert_array_equal(np.isnan(solved.columns[column]), lost)
    np.testing.assert_array_equal(solved.columns["confidence"] == 0, lost)


def test_points_without_a_place_are_not_used_and_named(tmp_path, caplog):
    take = Take(tmp_path)
    take.points[:, 3] = 99.0
    rows = [(name, str(vertex)) for name, vertex in PICKED.items() if name != "m3"]
    delimited.write(tmp_path / "virtual.tsv", ("point", "vertex"), rows)
    with caplog.at_level(logging.INFO):
        solved = take.solve()
    assert "no virtual marker: m3" in caplog.text
    np.testing.assert_allclose(solved.columns["face.smile"], take.weights[:, 1], atol=2e-3)


def test_a_place_between_vertices(tmp_path):
    take = Take(tmp_path)
    rows = [(name, f"{v},{v}", "0.25,0.75") for name, v in PICKED.items()]
    rows[0] = ("m0", "0, 0,0", "")
    delimited.write(tmp_path / "virtual.tsv", ("point", "vertex", "shares"), rows)
    solved = take.solve()
    np.testing.assert_allclose(solved.columns["face.smile"], take.weights[:, 1], atol=2e-3)


def test_limits_of_the_channels_are_kept(tmp_path):
    take = Take(tmp_path)
    table = tmp_path / "channels.tsv"
    delimited.write(table, ("shape", "low", "high"), [("smile", "0.2", "0.6")])
    solved = take.solve(channels=table)
    assert solved.columns["face.smile"].min() == pytest.approx(0.2)
    assert solved.columns["face.smile"].max() == pytest.approx(0.6)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([("m0", "30")], "line 2, column vertex: '30' is no vertex: they run from 0 to 29"),
        ([("m0", "-1")], "line 2, column vertex: '-1' is no vertex"),
        ([("m0", "1"), ("nose", "2")], "line 3, column point: the actor has no point 'nose'"),
        ([("m0", "1"), ("m0", "2")], "line 3: m0 stands twice"),
        ([("m0", "1"), ("m1", "2")], "lists 2 of the actor's points, at least 4"),
        ([], "lists 0 of the actor's points"),
        ([(f"m{i}", "1") for i in range(5)], "extent"),
    ],
)
def test_bad_virtual_markers_are_one_line(tmp_path, rows, message):
    take = Take(tmp_path)
    delimited.write(tmp_path / "virtual.tsv", ("point", "vertex"), rows)
    with pytest.raises(errors.InputError, match=rf"virtual\.tsv: .*{message}"):
        take.solve()


@pytest.mark.parametrize("shares", ["1", "1,x", "0,0", "1,nan"])
def test_bad_shares_are_one_line(tmp_path, shares):
    take = Take(tmp_path)
    delimited.write(
        tmp_path / "virtual.tsv", ("point", "vertex", "shares"), [("m0", "1,2", shares)]
    )
    with pytest.raises(errors.InputError, match="line 2, column shares"):
        take.solve()


def test_other_bad_input_is_one_line(tmp_path):
    take = Take(tmp_path)
    for changed, message in (
        ({"strength": -1}, "--strength: is -1"),
        ({"strength": "nan"}, "--strength"),
        ({"points": "video"}, "holds no video points"),
    ):
        with pytest.raises(errors.InputError, match=message):
            take.solve(**changed)


def test_the_same_input_gives_the_same_bytes(tmp_path):
    take = Take(tmp_path)
    take.solve()
    first = (tmp_path / "solved.parquet").read_bytes()
    take.solve()
    assert (tmp_path / "solved.parquet").read_bytes() == first
