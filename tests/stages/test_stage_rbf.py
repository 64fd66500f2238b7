import numpy as np
import pytest
from tuned_actor import FRAMES, SHAPES, TunedActor

from stages import train_rbf
from stages.files import errors, pair_residuals, rbf_model, series


@pytest.fixture
def actor(tmp_path):
    return TunedActor(tmp_path)


@pytest.mark.parametrize("kind", ["markers", "video"])
@pytest.mark.parametrize("regression", ["linear", "rbf_linear", "rbf"])
def test_another_shot_gets_the_planted_weights(tmp_path, kind, regression):
    actor = TunedActor(tmp_path, kind)
    train_rbf.main(actor.train_words(regression=regression))
    weights, read = actor.predicted()
    limit = 0.02 if "linear" in regression else 0.1
    assert np.abs(weights - actor.weights["talk"]).mean() < limit
    assert list(read.columns) == [*(f"face.{name}" for name in SHAPES), "distance", "confidence"]
    assert weights.min() >= 0
    assert weights.max() <= 1


def test_a_bent_actor_is_followed_better_than_by_a_linear_map(tmp_path):
    actor = TunedActor(tmp_path, bend=0.7)
    errors_of = {}
    for regression in ("linear", "rbf_linear"):
        train_rbf.main(actor.train_words(regression=regression))
        errors_of[regression] = np.abs(actor.predicted()[0] - actor.weights["talk"]).mean()
    assert errors_of["rbf_linear"] < 0.7 * errors_of["linear"]


def test_the_published_network_has_four_dimensions_and_no_linear_part(actor):
    words = actor.train_words(regression="rbf", dimensions="4", widths="published")
    train_rbf.main(words)
    learnt = rbf_model.read(actor.folder / "rbf.npz")
    assert learnt.regression.centres.shape == (60, 4)
    assert len(learnt.regression.linear) == 0
    assert not learnt.regression.constant.any()
    first = (actor.folder / "rbf.npz").read_bytes()
    train_rbf.main(words)
    assert (actor.folder / "rbf.npz").read_bytes() == first


def test_missing_points_cost_little_and_many_are_refused(actor):
    train_rbf.main(actor.train_words())
    whole, _ = actor.predicted()
    points = actor.moved(actor.weights["talk"])
    points[100:200, 3] = np.nan
    points[150:160, 4:7] = np.nan
    points[300:310, :8] = np.nan
    actor.write_expression("holes", points)
    holes, read = actor.predicted(shot="holes")
    assert np.isnan(holes[300:310]).all()
    assert not read.columns["confidence"][300:310].any()
    rest = np.delete(np.arange(FRAMES), np.arange(300, 310))
    assert np.abs(holes - whole)[rest].max() < 0.05
    assert np.isnan(read.columns["distance"][305])


def test_distance_grows_away_from_the_examples(actor):
    train_rbf.main(actor.train_words())
    actor.write_expression("far", actor.moved(4.0 * actor.weights["talk"]))
    _, near = actor.predicted(shot="rom")
    _, far = actor.predicted(shot="far")
    assert np.median(near.columns["distance"][actor.tuned]) < 0.1
    assert np.median(far.columns["distance"]) > 3 * np.median(near.columns["distance"])


def test_channels_limit_the_weights(actor):
    table = actor.folder / "channels.tsv"
    table.write_text("shape\tlow\thigh\njawOpen\t-0.5\t0.4\n")
    words = actor.train_words(channels=str(table))
    with pytest.raises(errors.InputError, match=r"ann.tsv: line \d+, column jawOpen.*0.4"):
        train_rbf.main(words)
    train_rbf.main(actor.train_words())
    weights, _ = actor.predicted(channels=str(table))
    assert weights[:, 0].max() == pytest.approx(0.4)


def test_a_planted_contradiction_is_ranked_first_and_blamed_on_its_neighbour(actor):
    weights = actor.weights["rom"]
    other = actor.tuned[20]
    wrong = 1 - weights[other]
    actor.write_pairs("bob", [("rom", other, wrong)])
    for regression in ("rbf", "linear", "rbf_linear"):
        pairs = ["ann.tsv", "bob.tsv"]
        train_rbf.main(actor.train_words(pairs=pairs, regression=regression))
        rows = pair_residuals.read(actor.folder / "pair_residuals.parquet")
        assert [row["rank"] for row in rows] == list(range(1, 62))
        assert (rows[0]["animator"], rows[0]["frame"]) == ("bob", other)
        assert (rows[0]["partner_animator"], rows[0]["partner_frame"]) == ("ann", other)


def test_rows_of_other_actors_and_points_that_are_never_seen_are_left_aside(actor):
    rows = [("rom", frame, actor.weights["rom"][frame]) for frame in actor.tuned]
    actor.write_pairs("ann", [*rows, ("theirs", 9999, np.zeros(5))])
    points = actor.moved(actor.weights["rom"])
    points[:, 2] = np.nan
    actor.write_expression("rom", points)
    train_rbf.main([*actor.train_words(), "--other-shots", "theirs"])
    learnt = rbf_model.read(actor.folder / "rbf.npz")
    assert len(learnt.examples) == 60
    assert "m2" not in learnt.point_names
    assert np.abs(actor.predicted()[0] - actor.weights["talk"]).mean() < 0.02


def test_cross_validation_limits_itself_to_the_pairs(actor):
    rows = [("rom", frame, actor.weights["rom"][frame]) for frame in actor.tuned[::20]]
    actor.write_pairs("few", rows)
    for regression in ("rbf", "linear", "rbf_linear"):
        train_rbf.main(actor.train_words(pairs=["few.tsv"], regression=regression))
        assert np.isfinite(actor.predicted()[0]).all()


@pytest.mark.parametrize(
    ("pairs", "options", "message"),
    [
        ("few.tsv", {"dimensions": "4"}, "few.tsv: 3 pairs are fewer than the 4 dimensions"),
        ("head.tsv", {}, "head.tsv: 0 pairs of rom: tune 3 at least"),
        ("ann.tsv", {"dimensions": "four"}, "--dimensions: 'four'"),
        ("ann.tsv", {"dimensions": "0"}, "--dimensions: '0'"),
        ("ann.tsv", {"dimensions": "50"}, "--dimensions: 50, but the points move in 42"),
        ("ann.tsv", {"min_confidence": "2"}, "rom.parquet: 0 of 400 frames"),
    ],
)
def test_what_cannot_be_trained_is_refused(actor, pairs, options, message):
    actor.write_pairs("few", [("rom", frame, np.zeros(5)) for frame in (1, 50, 90)])
    actor.write_pairs("head", [])
    with pytest.raises(errors.InputError, match=message):
        train_rbf.main(actor.train_words(pairs=[pairs], **options))


def test_a_pair_on_a_frame_without_points_is_named(actor):
    points = actor.moved(actor.weights["rom"])
    points[actor.tuned[5], :9] = np.nan
    actor.write_expression("rom", points)
    with pytest.raises(errors.InputError, match=r"ann.tsv: line 7: 36% of the points"):
        train_rbf.main(actor.train_words())


def test_a_shot_without_such_points_is_refused(actor):
    with pytest.raises(errors.InputError, match="rom.parquet: holds no video points"):
        train_rbf.main(actor.train_words(points="video"))


def test_another_rig_or_other_points_are_refused(actor):
    train_rbf.main(actor.train_words())
    points = actor.moved(actor.weights["talk"])
    actor.names = [name if k < 3 else f"{name}_new" for k, name in enumerate(actor.names)]
    actor.write_expression("renamed", points)
    with pytest.raises(errors.InputError, match=r"renamed.parquet: 11 of the 14 points.*m3"):
        actor.predicted(shot="renamed")
    actor.write_rig(SHAPES[:4])
    with pytest.raises(errors.InputError, match=r"rbf.npz: was trained for .* 5 shapes, not"):
        actor.predicted()


def test_the_rate_and_frames_of_the_shot_are_kept(actor):
    train_rbf.main(actor.train_words())
    _, read = actor.predicted()
    expression = series.read(actor.folder / "talk.parquet", "expression")
    assert read.rate == expression.rate
    np.testing.assert_array_equal(read.frame, expression.frame)
