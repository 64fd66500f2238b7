"""fit_pca, select_key_shapes and solve_weights on a face that is known."""

from fractions import Fraction

import numpy as np
import pytest

from stages import fit_pca, select_key_shapes, solve_weights
from stages.core import pca
from stages.files import errors, key_shapes, model, series

POINTS = [f"lips_{i:02d}" for i in range(8)] + [f"brow_{i:02d}" for i in range(4)]
CORNERS = {"mouth": [5, 17, 33], "brows": [8, 40]}
SIZES = {"mouth": 8, "brows": 4}


def _take(seed, frames=60):
    """Return neutral (12, 2), extremes and weights by region, and points (T, 12, 2)."""
    rng = np.random.default_rng(41)
    neutral = rng.normal(size=(12, 2))
    extremes = {r: 0.2 * rng.normal(size=(len(CORNERS[r]), SIZES[r], 2)) for r in SIZES}
    rng = np.random.default_rng(seed)
    weights = {
        region: rng.dirichlet(np.ones(len(rows) + 1), frames)[:, :-1] * 0.8
        for region, rows in CORNERS.items()
    }
    return neutral, extremes, weights


def _write(path, neutral, extremes, weights, doubtful=(), missing=()):
    """Write an expression; frames in `doubtful` are wild and hardly trusted."""
    parts = [np.einsum("tk,kpd->tpd", weights[r], extremes[r]) for r in SIZES]
    points = neutral + np.concatenate(parts, axis=1)
    confidence = np.ones(len(points))
    for frame in doubtful:
        points[frame] *= 30
        confidence[frame] = 0.1
    for frame, point in missing:
        points[frame, point] = np.nan
    columns = series.unstack(points, POINTS) | {
        "confidence": confidence,
        **{f"{name}.confidence": confidence for name in POINTS},
    }
    meta = {"points": POINTS, "neutral": neutral.tolist()}
    frame = np.arange(len(points))
    series.write(path, "expression", frame, frame / 30, columns, Fraction(30), meta)


class Show:
    """A folder with tables and two basis shots, and the stages' command lines."""

    def __init__(self, folder):
        self.folder = folder
        neutral, extremes, self.weights = _take(1)
        for region, rows in CORNERS.items():
            self.weights[region][rows] = np.eye(len(rows))
        self.neutral, self.extremes = neutral, extremes
        _write(folder / "a.parquet", neutral, extremes, self.weights, doubtful=[50, 51])
        _write(folder / "b.parquet", neutral, extremes, _take(2)[2])
        self.table("regions", "region point weight", "mouth lips 1", "brows brow 2")
        self.settings("mouth 3", "brows 2")
        self.locks()

    def table(self, name, *rows):
        text = "".join(row.replace(" ", "\t") + "\n" for row in rows)
        (self.folder / f"{name}.tsv").write_text(text)

    def settings(self, *rows, columns="region count"):
        self.table("settings", columns, *rows)

    def locks(self, *rows):
        self.table("locks", "actor region shot frame state", *rows)

    def path(self, name):
        return str(self.folder / name)

    def basis(self):
        shots = [self.path("a.parquet"), self.path("b.parquet")]
        return ["--expressions", *shots, "--shots", "a", "b", "--regions", self.path("regions.tsv")]

    def choose(self):
        limit = ["--min-confidence", "0.5"]
        fit_pca.main([*self.basis(), *limit, "--pca", self.path("pca.npz")])
        tables = ["--region-settings", self.path("settings.tsv")]
        tables += ["--key-shape-table", self.path("locks.tsv"), "--actor", "ada"]
        made = ["--key-shapes", self.path("ks.parquet"), "--errors", self.path("e.parquet")]
        more = ["--pca", self.path("pca.npz"), "--seed", "1"]
        select_key_shapes.main([*self.basis(), *limit, *tables, *more, *made])
        return key_shapes.read(self.path("ks.parquet"))

    def solve(self, shot):
        solve_weights.main(
            [
                *("--expression", self.path(shot), "--key-shapes", self.path("ks.parquet")),
                *("--regions", self.path("regions.tsv")),
                *("--region-settings", self.path("settings.tsv")),
                *("--key-weights", self.path("kw.parquet")),
            ]
        )
        return series.read(self.path("kw.parquet"), "key_weights")


@pytest.fixture(name="made")
def _made(tmp_path, monkeypatch):
    # few counts are measured, for speed
    monkeypatch.setattr(select_key_shapes, "COUNTS", (2, 4))
    return Show(tmp_path)


def chosen(shapes, region):
    return [(shape.shot, shape.frame) for shape in shapes if shape.region == region]


def test_extremes_are_chosen_and_their_weights_recovered(made):
    made.settings(
        "mouth 3 nonnegative_offset", "brows 2 least_squares", columns="region count solve"
    )
    shapes = made.choose()
    for region, rows in CORNERS.items():
        assert sorted(chosen(shapes, region)) == [("a", row) for row in rows]
    solved = made.solve("b.parquet")
    planted = _take(2)[2]
    for region, rows in CORNERS.items():
        for column, row in enumerate(rows):
            found = solved.columns[f"{region}.a_f{row:04d}"]
            np.testing.assert_allclose(found, planted[region][:, column], atol=1e-4)
        assert solved.columns[f"{region}.residual"].max() < 1e-5
        assert solved.columns[f"{region}.kkt_residual"].max() < 1e-5


def test_key_shapes_say_where_they_stand_and_why(made):
    shapes = made.choose()
    assert [shape.order for shape in shapes] == [0, 1, 2, 0, 1]
    for shape in shapes:
        assert shape.key_shape == f"{shape.shot}_f{shape.frame:04d}"
        assert shape.reason
        assert shape.count_reason == "set in region_settings.tsv"
        assert shape.confidence == 1
        assert not shape.locked
    points = key_shapes.read_points(made.path("ks.parquet"))
    assert points == {"mouth": POINTS[:8], "brows": POINTS[8:]}
    mouth = next(shape for shape in shapes if (shape.region, shape.frame) == ("mouth", 5))
    expected = made.neutral[:8] + made.extremes["mouth"][0]
    np.testing.assert_allclose(np.reshape(mouth.shape, (8, 2)), expected, atol=1e-6)


def test_axes_are_those_of_the_trusted_frames(made):
    made.choose()
    arrays, meta = model.read(made.path("pca.npz"), "pca")
    assert meta["points"]["brows"] == POINTS[8:]
    points = [
        series.stack(series.read(made.path(f"{shot}.parquet"), "expression"), "", POINTS)
        for shot in "ab"
    ]
    points[0] = np.delete(points[0], [50, 51], axis=0)
    frames = np.concatenate(points)[:, 8:].reshape(-1, 8) / 2
    np.testing.assert_allclose(arrays["brows.variance"][:2], pca.fit(frames).variance[:2])


def test_locked_frames_are_kept_and_banned_ones_replaced(made):
    made.locks("ada mouth b 7 locked", "ada mouth a 17 banned", "eve mouth a 5 banned")
    shapes = made.choose()
    assert chosen(shapes, "mouth")[0] == ("b", 7)
    assert ("a", 17) not in chosen(shapes, "mouth")
    assert [shape.locked for shape in shapes] == [True, False, False, False, False]
    assert sorted(chosen(shapes, "brows")) == [("a", 8), ("a", 40)]


def test_a_doubtful_locked_frame_is_kept_with_a_warning(made, caplog):
    made.locks("ada mouth a 50 locked")
    shapes = made.choose()
    assert chosen(shapes, "mouth")[0] == ("a", 50)
    assert "confidence 0.10" in caplog.text
    assert ("a", 51) not in [(shape.shot, shape.frame) for shape in shapes]


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("ada mouth a 60 locked", "line 2: frame 60 of shot a is outside the basis"),
        ("ada mouth talk 3 locked", "set basis to yes for talk"),
        ("ada mouth a x locked", "not a whole number"),
        ("ada mouth a 3 held", "'held' is not locked or banned"),
    ],
)
def test_locks_that_cannot_be_met_are_named(made, row, words):
    made.locks(row)
    with pytest.raises(errors.InputError, match=words) as caught:
        made.choose()
    assert str(caught.value).startswith(made.path("locks.tsv"))


def test_a_frame_locked_twice_is_named(made):
    made.locks("ada mouth a 3 locked", "ada mouth a 3 banned")
    with pytest.raises(errors.InputError, match="line 3: the same frame stands above"):
        made.choose()


def test_counts_follow_the_budget_or_the_knee_and_say_so(made):
    made.settings("mouth budget 0.02", "brows knee ", columns="region count budget")
    shapes = made.choose()
    assert len(chosen(shapes, "mouth")) == 4
    assert "within the budget of 0.02" in shapes[0].count_reason
    assert "knee of the held-out error" in shapes[-1].count_reason


def test_every_method_is_measured_on_both_splits(made):
    made.choose()
    rows = key_shapes.read_errors(made.path("e.parquet"))
    measured = {(row["region"], row["method"], row["split"]) for row in rows}
    assert len(measured) == 2 * 11 * 2
    assert all(row["rms"] >= 0 for row in rows)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (["mouth 3"], "region brows has no row"),
        (["mouth 300", "brows 2"], "300 key shapes cannot be chosen"),
        (["mouth budget", "brows 2"], "so give the budget"),
        (["mouth 3", "mouth 3", "brows 2"], "mouth stands twice"),
    ],
)
def test_settings_that_cannot_be_met_are_named(made, rows, words):
    made.settings(*rows)
    with pytest.raises(errors.InputError, match=words):
        made.choose()


def test_frames_with_missing_points_are_solved_on_the_others(made):
    made.settings(
        "mouth 3 nonnegative_offset", "brows 2 least_squares", columns="region count solve"
    )
    made.choose()
    planted = _take(3)[2]
    missing = [(4, 0), (4, 3), *((9, point) for point in range(6))]
    _write(made.folder / "c.parquet", made.neutral, made.extremes, planted, missing=missing)
    solved = made.solve("c.parquet")
    name = f"mouth.a_f{CORNERS['mouth'][0]:04d}"
    assert solved.columns[name][4] == pytest.approx(planted["mouth"][4, 0], abs=1e-4)
    assert np.flatnonzero(np.isnan(solved.columns[name])).tolist() == [9]
    assert np.isfinite(solved.columns["brows.residual"]).all()


def test_key_shapes_of_other_points_are_refused(made):
    made.choose()
    made.table("regions", "region point weight", "mouth lips 1", "brows brow_00 1")
    with pytest.raises(errors.InputError, match="region brows have other points"):
        made.solve("b.parquet")


def test_the_same_inputs_give_the_same_bytes(made):
    made.choose()
    names = ("pca.npz", "ks.parquet", "e.parquet")
    first = [(made.folder / name).read_bytes() for name in names]
    made.choose()
    assert [(made.folder / name).read_bytes() for name in names] == first
