"""The session `play` of the example: markers, films, labels, planted layers and truth."""

import collections
import csv
import pathlib

import av
import ezc3d
import numpy as np
import pytest
from scipy.spatial import transform

from data_example import generate
from data_example.generator import (
    capture,
    contours,
    landmarks,
    markers,
    params,
    play,
    play_cues,
    play_files,
    play_speech,
    play_truth,
    shots,
    skin,
    spoken,
)

FOLDER = pathlib.Path(generate.__file__).parent
HERE = FOLDER / "play"
RATE = play.RATE
SOUND_RATE = 16000
STEP = 30
# of the films, the markers, the labels and the truth of the session
LIMIT = 2.1e6
# the gap below which lips touch [mm]
TOUCH_MM = 0.1


@pytest.fixture(scope="module")
def mia_skin():
    body = skin.build()
    return body, markers.glue(body)


@pytest.fixture(scope="module")
def brows():
    return landmarks.brows()


def known(name):
    with np.load(FOLDER / "truth" / f"{name}.npz") as arrays:
        return dict(arrays)


def captured(name):
    file = ezc3d.c3d(str(HERE / f"{name}.c3d"))
    points = file["data"]["points"][:3].transpose(2, 1, 0)
    points[file["data"]["meta_points"]["residuals"][0].T < 0] = np.nan
    return file["parameters"]["POINT"], points


def column(name):
    return params.NAMES.index(name)


@pytest.mark.parametrize("name", play.TAKES)
def test_another_reader_finds_the_true_markers_at_60_hz(name, mia_skin):
    point, points = captured(name)
    kept = known(name)
    assert point["RATE"]["value"] == [RATE]
    assert point["UNITS"]["value"] == ["mm"]
    assert point["LABELS"]["value"] == [f"mia:{marker}" for marker in markers.NAMES]
    assert len(points) == len(kept["expression"]) == play.TAKES[name]().frames
    frames = np.arange(0, len(points), STEP)
    still, _ = capture.true_markers(*mia_skin, play.expression(name, frames / RATE))
    turns = transform.Rotation.from_quat(kept["quaternion"][frames]).as_matrix()
    world = markers.moved(still, turns, kept["translation"][frames])
    off = points[frames] - capture.in_system(world)
    assert 0.13 < np.sqrt(np.nanmean(off**2)) < 0.17
    assert np.nanmax(np.abs(off)) < 1.0


@pytest.mark.parametrize("name", play.TAKES)
def test_what_is_missing_is_what_the_truth_says(name):
    missing = np.isnan(captured(name)[1]).any(axis=2)
    expected = np.zeros_like(missing)
    for line in known(name)["gaps"]:
        marker, first, count = str(line).split()
        expected[int(first) : int(first) + int(count), markers.NAMES.index(marker)] = True
    assert (missing == expected).all()
    assert missing.any() == (name == "vignette")


@pytest.mark.parametrize("name", play.TAKES)
def test_two_marker_frames_fall_on_every_picture(name):
    with av.open(str(HERE / f"{name}.mp4")) as container:
        picture, sound = container.streams.video[0], container.streams.audio[0]
        assert (picture.codec_context.name, sound.codec_context.name) == ("h264", "aac")
        assert picture.average_rate == shots.RATE
        assert picture.width == picture.height == capture.PICTURE
        count = sum(packet.pts is not None for packet in container.demux(picture))
    assert 2 * count == play.TAKES[name]().frames


def test_the_voice_of_the_film_is_heard_where_its_words_are():
    with av.open(str(HERE / "vignette.mp4")) as container:
        resampler = av.AudioResampler("flt", "mono", SOUND_RATE)
        blocks = [
            part.to_ndarray()[0]
            for frame in container.decode(audio=0)
            for part in resampler.resample(frame)
        ]
    samples = np.concatenate(blocks)
    loud = np.sqrt(np.convolve(samples**2, np.full(800, 1 / 800), "same"))
    times = np.arange(len(samples)) / SOUND_RATE
    phones = play.vignette().phones
    spoken_then = np.zeros(len(times), bool)
    for phone in phones:
        if phone.name in ("aa", "ao", "ow", "ae", "eh", "iy"):
            spoken_then |= (times > phone.start) & (times < phone.end)
    ends = [(p.start - 0.3, p.end + 0.5) for p in phones]
    silent = ~np.any([(times > first) & (times < last) for first, last in ends], axis=0)
    assert np.median(loud[spoken_then]) > 5 * np.median(loud[silent])


def test_the_transcript_has_the_words_that_are_said():
    said = [word for word, _, _ in spoken.words(play.vignette().phones) if word]
    assert (HERE / "vignette.txt").read_text(encoding="utf-8").split() == said
    assert len(said) > 25


@pytest.mark.parametrize("name", play.TAKES)
def test_truth_is_made_again_from_its_seeds(name, mia_skin, brows):
    kept, made = known(name), play_truth.of_take(name, *mia_skin, brows)
    assert set(kept) == set(made)
    for key, value in made.items():
        if value.dtype.kind == "f":
            np.testing.assert_allclose(kept[key], value, atol=2e-3)
        else:
            assert (kept[key] == value).all()


@pytest.mark.parametrize("name", play.TAKES)
def test_markers_are_made_again_byte_by_byte(name, mia_skin, tmp_path):
    number = list(play.TAKES).index(name)
    played = play_truth.played(name, RATE)
    seed = play_files.MARKER_SEED + number
    path = tmp_path / "again.c3d"
    capture.write_markers(path, play.TAKES[name](), played, *mia_skin, RATE, seed)
    assert path.read_bytes() == (HERE / f"{name}.c3d").read_bytes()


def test_every_extreme_is_reached_held_and_left():
    kept = known("faces")
    basis = dict(zip(kept["extreme_names"], kept["poses"], strict=True))
    assert len(basis) == 15 + 12 + 3
    frames = dict(zip(kept["extreme_names"], kept["extreme_frame"], strict=True))
    assert len(set(frames.values())) == len(frames)
    resting = {"emotion_neutral", "speech_rest", "blink_open"}
    for name, frame in frames.items():
        assert frame % (RATE // shots.RATE) == 0
        held = kept["expression"][frame - 5 : frame + 6].astype(float)
        assert np.abs(held - basis[name]).max() < 0.02
        if name not in resting:
            for away in (frame - 29, frame + 29):
                assert np.abs(kept["expression"][away] - basis[name]).max() > 0.1


def test_the_first_frame_row_is_neutral_and_its_head_stands_still():
    kept = known("faces")
    frame = play.extreme_frames()["emotion_neutral"]
    assert np.abs(kept["expression"][: frame + 6]).max() == 0
    np.testing.assert_allclose(kept["translation"][: frame + 1], 0, atol=1e-6)


def test_no_two_extremes_of_a_layer_nearly_coincide_on_the_markers(mia_skin):
    still, _ = capture.true_markers(*mia_skin, play.poses())
    for layer in play.LAYERS:
        at = [i for i, name in enumerate(play.NAMES) if name.startswith(layer)]
        flat = still[at].reshape(len(at), -1)
        apart = np.linalg.norm(flat[:, None] - flat[None], axis=2)
        size = np.linalg.norm(flat - flat[0], axis=1)[1:].mean()
        assert apart[~np.eye(len(at), dtype=bool)].min() > 0.2 * size


def test_degrees_of_an_emotion_grow(mia_skin):
    still, _ = capture.true_markers(*mia_skin, play.poses())
    size = dict(zip(play.NAMES, np.linalg.norm(still - still[0], axis=(1, 2)), strict=True))
    for degrees in (
        ("serenity", "joy", "ecstasy"),
        ("sadness", "grief"),
        ("anger", "rage"),
        ("surprise", "amazement"),
    ):
        sizes = [size[f"emotion_{name}"] for name in degrees]
        assert sizes == sorted(sizes)


def test_planted_coefficients_lie_on_their_simplices_and_strengths_go_beyond():
    kept = known("vignette")
    coefficient = kept["coefficient"].astype(float)
    assert coefficient.min() >= 0
    for layer in play.LAYERS:
        at = [i for i, name in enumerate(kept["extreme_names"]) if name.startswith(layer)]
        np.testing.assert_allclose(coefficient[:, at].sum(axis=1), 1, atol=0.01)
    strength = kept["strength"].astype(float)
    assert strength.min() >= 0
    assert 1.1 < strength.max() <= 1.16
    beyond = (strength[:, 0, 0] > 1.08).mean()
    assert 0.1 < beyond < 0.3


def test_one_emotion_follows_another_through_blends():
    kept = known("vignette")
    names = [f"emotion_{name}" for name in play_cues.EXTREMES["emotion"]]
    coefficient = kept["coefficient"][:, : len(names)].astype(float)
    strongest = [names[i].split("_")[1] for i in coefficient.argmax(axis=1)]
    order = list(dict.fromkeys(strongest))
    places = [order.index(name) for name in ("joy", "amazement", "anger", "rage", "sadness")]
    assert places == sorted(places)
    blended = np.sort(coefficient, axis=1)[:, -2] > 0.2
    assert blended.mean() > 0.25


def test_lips_touch_on_every_p_b_and_m_and_are_open_in_vowels():
    kept = known("vignette")
    times = np.arange(len(kept["opening_mm"])) / RATE
    counts = collections.Counter()
    for phone, start, end in zip(
        kept["phones"], kept["phone_start_s"], kept["phone_end_s"], strict=True
    ):
        during = kept["opening_mm"][(times > start - 0.03) & (times < end + 0.03)]
        if phone in ("p", "b", "m"):
            assert (during < TOUCH_MM).sum() >= 2
            counts["closed"] += 1
        if phone in ("aa", "ao", "ae", "ow"):
            assert during.max() > 3
            counts["open"] += 1
    assert counts["closed"] >= 8
    assert counts["open"] >= 6


def test_lids_close_on_every_blink_of_the_vignette():
    shut = known("vignette")["expression"][:, column("blink_l")] > 0.95
    assert np.count_nonzero(np.diff(shut.astype(int)) == 1) == len(play_cues.VIGNETTE_BLINKS)


def test_the_head_moves_strongly_and_stays_in_the_picture():
    kept = known("vignette")
    turned = transform.Rotation.from_quat(kept["quaternion"]).magnitude()
    assert 15 < np.rad2deg(turned.max()) < 30
    assert kept["landmarks"].min() > 20
    assert kept["landmarks"].max() < capture.PICTURE - 20


def test_every_phone_has_a_viseme_of_the_layer():
    for sentence in spoken.phones().values():
        for phone in sentence:
            for part in play_speech.SOUNDS[phone.name].split():
                assert part.partition(":")[0] in play_speech.VISEMES


@pytest.mark.parametrize("name", play.TAKES)
def test_labels_lie_on_the_true_contours(name, brows):
    shown = play_truth.played(name, shots.RATE)
    labelled = collections.defaultdict(dict)
    with (FOLDER / "labels" / f"{name}.csv").open(encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            place = float(row["x_px"]), float(row["y_px"])
            labelled[int(row["frame"])][row["point"]] = np.array(place)
    assert tuple(labelled) == play_files.labelled(name)
    off = []
    for frame, lines in play_truth.drawn(shown, labelled, brows):
        assert list(labelled[frame]) == contours.names(2)
        dense = {name: finely(name, line) for name, line in lines.items()}
        for point, place in labelled[frame].items():
            line = dense[next(name for name in dense if point.startswith(name))]
            off.append(np.linalg.norm(line - place, axis=1).min())
    assert 0.1 < np.sqrt(np.mean(np.square(off))) < 0.25
    assert max(off) < 1.0


def finely(name, line):
    kind = contours.POINT_SET[name][0]
    closed = np.concatenate([line, line[:1]]) if kind == "closed" else line
    return contours.along(closed, np.linspace(0, 1, 4000))


def test_the_session_stays_small():
    files = [*HERE.iterdir(), *(FOLDER / "labels" / f"{name}.csv" for name in play.TAKES)]
    files += [FOLDER / "truth" / f"{name}.npz" for name in play.TAKES]
    assert sum(path.stat().st_size for path in files) < LIMIT
