import logging
from fractions import Fraction

import numpy as np
import pytest
from small_take import changed_by, words

from stages import direct_layers, smooth_weights
from stages.core import local_shapes
from stages.files import errors, layers, rig, series, weights

EXTREMES = "stages/tables/extremes.tsv"
RATE = Fraction(30)
FRAMES = 90
MASKS = ["upper", "mouth", "eyes"]
LAYERS = ["emotion", "speech", "blink"]
TAKEN = [
    ("emotion", "neutral"),
    ("emotion", "annoyance"),
    ("emotion", "anger"),
    ("emotion", "rage"),
    ("emotion", "joy"),
    ("speech", "rest"),
    ("speech", "m"),
    ("blink", "open"),
    ("blink", "closed"),
]
HEADER = "character\tshot\tlayer\tname\tgain\tstart_s\tend_s\tfade_s"
# the rig has an extreme that the take lacks, and not every pair
SHOWN = ["emotion_annoyance", "emotion_anger", "emotion_rage", "emotion_joy", "emotion_grief"]
COLUMNS = [f"upper.{name}" for name in SHOWN]
COLUMNS += [f"mouth.{name}" for name in (*SHOWN, "speech_m")]
COLUMNS += ["eyes.blink_closed", "eyes.speech_m"]


class DirectedTake:
    """A folder with layers, a rig and a table of gains."""

    def __init__(self, folder, names=COLUMNS):
        self.folder = folder
        rng = np.random.default_rng(3)
        self.weights = rng.dirichlet(np.ones(len(LAYERS)), (FRAMES, len(MASKS)))
        parts = [
            rng.dirichlet(np.ones([layer for layer, _ in TAKEN].count(name)), FRAMES)
            for name in LAYERS
        ]
        self.coefficients = np.concatenate(parts, axis=1)
        self.amplitudes = rng.uniform(1, 1.3, (FRAMES, len(MASKS)))
        self.weights[40], self.coefficients[40], self.amplitudes[40] = np.nan, np.nan, np.nan
        frame = np.arange(FRAMES)
        self.time_s = frame / float(RATE)
        values = np.zeros(FRAMES)
        take = layers.Layers(
            frame,
            self.time_s,
            RATE,
            MASKS,
            LAYERS,
            TAKEN,
            self.weights,
            self.coefficients,
            self.amplitudes,
            dict.fromkeys(layers.MEASURES, values),
            np.full(FRAMES, 0.75),
        )
        layers.write(folder / "layers.parquet", take, {}, [])
        self.write_rig(names)

    def write_rig(self, names):
        """Write a rig of three vertices, each under its own mask."""
        owners = sorted({name.partition(".")[0] for name in names} | set(MASKS))
        index = np.array([owners.index(name.partition(".")[0]) for name in names], np.int32)
        deltas = local_shapes.gather(np.eye(len(owners))[index][:, :, None] * np.ones(3))
        none = np.zeros(0, np.int32)
        neutral, masks = np.zeros((len(owners), 3)), np.eye(len(owners))
        fields = neutral, deltas, masks, index, none, none, np.zeros((0, 3)), np.zeros(3)
        rig.write(
            self.folder / "rig.npz", rig.Rig(list(names), owners, [], *fields, "cm", "y", 6.5)
        )

    def direct(self, *rows, **changed):
        """Run the stage with a table of some rows; return its columns."""
        path = self.folder / "directing.tsv"
        path.write_text("\n".join([HEADER, *rows]) + "\n")
        options = {
            "layers": f"{self.folder}/layers.parquet",
            "rig": f"{self.folder}/rig.npz",
            "directing": str(path) if rows else "",
            "character": "oliver",
            "shot": "vignette",
            "extremes": EXTREMES,
            "directed": f"{self.folder}/directed.parquet",
        } | changed_by(changed)
        direct_layers.main(words(options))
        return series.read(self.folder / "directed.parquet", "directed").columns

    def composed(self, mask, layer, name):
        """Compose one column by the written formula."""
        k, j = TAKEN.index((layer, name)), LAYERS.index(layer)
        at = MASKS.index(mask)
        return self.weights[:, at, j] * self.coefficients[:, k] * self.amplitudes[:, at]


@pytest.fixture
def take(tmp_path):
    return DirectedTake(tmp_path)


def test_columns_are_the_product_and_what_the_actor_lacks_rests(take, caplog):
    with caplog.at_level(logging.INFO):
        found = take.direct()
    assert list(found) == [*COLUMNS, "confidence"]
    assert "so they rest: emotion_grief" in caplog.text
    for name in COLUMNS:
        mask, _, extreme = name.partition(".")
        layer, _, plain = extreme.partition("_")
        if plain == "grief":
            wanted = np.where(np.arange(FRAMES) == 40, np.nan, 0.0)
        else:
            wanted = take.composed(mask, layer, plain)
        np.testing.assert_allclose(found[name], wanted, atol=1e-7)
    np.testing.assert_array_equal(found["confidence"], 0.75)


def test_one_emotion_at_zero_leaves_all_else_bit_for_bit(take):
    plain = take.direct()
    found = take.direct("oliver\t\temotion\tanger\t0\t\t\t")
    for name in COLUMNS:
        if name.rpartition("_")[2] in ("annoyance", "anger", "rage"):
            assert np.nanmax(np.abs(found[name])) == 0.0
            assert np.nanmax(plain[name]) > 0.1
        else:
            np.testing.assert_array_equal(found[name], plain[name])


def test_an_extreme_of_a_family_may_stand_alone_and_rows_multiply(take):
    plain = take.direct()
    found = take.direct(
        "oliver\t\temotion\trage\t0.5\t\t\t",
        "oliver\tvignette\temotion\t\t1.5\t1\t2\t0.25",
        "oliver\tother\temotion\t\t0\t\t\t",
        "nobody\t\tspeech\t\t0\t\t\t",
    )
    at, out = (take.time_s >= 1.25) & (take.time_s <= 1.75), (take.time_s < 1) | (take.time_s > 2)
    for name, gain in (("rage", 0.5), ("anger", 1.0)):
        curves = found[f"mouth.emotion_{name}"], plain[f"mouth.emotion_{name}"]
        np.testing.assert_allclose(curves[0][at], 1.5 * gain * curves[1][at], rtol=1e-6)
        np.testing.assert_allclose(curves[0][out], gain * curves[1][out], rtol=1e-6)
    np.testing.assert_array_equal(found["mouth.speech_m"], plain["mouth.speech_m"])


def test_a_neutral_that_is_a_pose_gets_what_gains_take(take):
    names = ["mouth.emotion_neutral", "mouth.emotion_joy", "mouth.emotion_rage"]
    take.write_rig(names)
    plain, found = take.direct(), take.direct("oliver\t\temotion\trage\t0.25\t\t\t")
    taken = plain["mouth.emotion_rage"] - found["mouth.emotion_rage"]
    np.testing.assert_allclose(taken, 0.75 * plain["mouth.emotion_rage"], atol=1e-7)
    given = found["mouth.emotion_neutral"] - plain["mouth.emotion_neutral"]
    np.testing.assert_allclose(given, taken, atol=1e-7)
    np.testing.assert_array_equal(found["mouth.emotion_joy"], plain["mouth.emotion_joy"])


def smoothed(take, smoothing):
    """Run smooth_weights on what was directed, with a head that is still."""
    frames = np.arange(FRAMES)
    still = {f"rotation.{axis}": np.zeros(FRAMES) for axis in "xyz"}
    still |= {"rotation.w": np.ones(FRAMES), "scale": np.ones(FRAMES)}
    still |= {f"translation.{axis}": np.zeros(FRAMES) for axis in "xyz"}
    head = take.folder / "head_motion.parquet"
    series.write(head, "head_motion", frames, take.time_s, still, RATE)
    options = {
        "solution": f"{take.folder}/directed.parquet",
        "head-motion": str(head),
        "rig": f"{take.folder}/rig.npz",
        "channels": "",
        "smoothing": smoothing,
        "lip-points": "",
        "rate": "film",
        "head": "apply",
        "first-frame": "",
        "last-frame": "",
        "handles": "",
        "start-timecode": "",
        "weights": f"{take.folder}/weights.parquet",
        "csv": f"{take.folder}/weights.csv",
    }
    smooth_weights.main(words(options))
    return weights.read(take.folder / "weights.parquet", COLUMNS)


def test_what_is_directed_has_no_limits_and_its_gaps_are_filled(take):
    take.direct("oliver\t\temotion\t\t4\t\t\t")
    baked = smoothed(take, "none")
    expected = 4 * take.composed("mouth", "emotion", "joy")
    assert np.nanmax(expected) > 1.0
    expected[40] = (expected[39] + expected[41]) / 2
    np.testing.assert_allclose(
        baked.shapes[:, COLUMNS.index("mouth.emotion_joy")], expected, atol=1e-6
    )
    assert (baked.confidence == 0).nonzero()[0].tolist() == [40]


def test_the_motion_filter_keeps_weights_on_their_simplices(take):
    plain = take.direct()
    baked = smoothed(take, "multiresolution")
    assert baked.shapes.min() >= 0.0
    for mask in MASKS:
        part = [number for number, name in enumerate(COLUMNS) if name.startswith(f"{mask}.")]
        before = np.nanmax(sum(plain[COLUMNS[number]] for number in part))
        after = baked.shapes[:, part].sum(axis=1)
        assert after.max() <= before + 1e-6
    jump = np.abs(np.diff(baked.shapes[:, COLUMNS.index("upper.emotion_joy")])).mean()
    assert jump < 0.8 * np.nanmean(np.abs(np.diff(plain["upper.emotion_joy"])))


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("oliver\t\temotion\tangr\t0\t\t\t", "line 2, column name: emotion has no 'angr', .*anger"),
        ("oliver\t\tspeech\tanger\t0\t\t\t", "line 2, column name: speech has no 'anger'"),
        ("oliver\t\tmouth\t\t0\t\t\t", "line 2, column layer: 'mouth' is no layer: .*speech"),
        ("oliver\t\tspeech\t\t-1\t\t\t", "line 2, column gain: '-1' is not within 0 and 100"),
        ("oliver\t\tspeech\t\t1e39\t\t\t", "line 2, column gain: '1e39' is not within 0"),
        ("oliver\t\tspeech\t\t\t\t\t", "line 2, column gain: '' is not a number"),
        (
            "oliver\t\tspeech\t\t1\t3\t2\t",
            "line 2: the end, 2 s, is not after the start, 3 s: correct",
        ),
        ("oliver\t\tspeech\t\t1\t2\t2.3\t0.2", "line 2: .* no room for fades of 0.2 s: correct"),
        ("nobody\t\tspeech\t\t1\tx\t3\t", "line 2, column start_s: 'x' is not a number"),
    ],
)
def test_rows_that_mean_nothing_are_named(take, row, message):
    with pytest.raises(errors.InputError, match=rf"directing\.tsv: {message}"):
        take.direct(row)
    assert not (take.folder / "directed.parquet").exists()


def test_rows_that_contradict_are_named_and_those_that_follow_are_not(take):
    first = "oliver\t\temotion\tanger\t0\t0\t2\t"
    take.direct(first, "oliver\t\temotion\tanger\t2\t2\t3\t")
    with pytest.raises(errors.InputError, match=r"line 3: meets line 2.*oliver emotion anger"):
        take.direct(first, "oliver\t\temotion\tanger\t2\t1.5\t3\t")


def test_files_that_do_not_belong_together_are_named(take, caplog):
    take.write_rig(["nose.emotion_joy"])
    with pytest.raises(errors.InputError, match=r"layers\.parquet: has no mask 'nose'"):
        take.direct()
    take.write_rig(["upper.jawOpen"])
    with pytest.raises(errors.InputError, match=r"rig\.npz: 'upper\.jawOpen' is of no layer"):
        take.direct()
    take.write_rig(COLUMNS)
    with caplog.at_level(logging.WARNING):
        take.direct("oliver\t\temotion\tfear\t0\t\t\t")
    assert "directing.tsv, line 2: the take holds none of it" in caplog.text
