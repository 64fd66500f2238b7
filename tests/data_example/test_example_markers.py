"""The marker takes of the example: markers, film, sounds, words and truth."""

import pathlib

import av
import ezc3d
import numpy as np
import pytest
from praatio import textgrid
from scipy import signal
from scipy.spatial import transform

from data_example import generate
from data_example.generator import (
    capture,
    marker_cues,
    marker_takes,
    marker_truth,
    markers,
    params,
    skin,
    spoken,
    tuned_pairs,
)

FOLDER = pathlib.Path(generate.__file__).parent
HERE = FOLDER / "capture"
RATE = marker_takes.RATE
STEP = 45
SOUND_RATE = 16000


@pytest.fixture(scope="module")
def mia_skin():
    body = skin.build()
    return body, markers.glue(body)


def read(name):
    file = ezc3d.c3d(str(HERE / f"{name}.c3d"))
    points = file["data"]["points"][:3].transpose(2, 1, 0)
    missing = file["data"]["meta_points"]["residuals"][0].T < 0
    points[missing] = np.nan
    return file["parameters"]["POINT"], points


def known(name):
    with np.load(FOLDER / "truth" / f"{name}.npz") as arrays:
        return dict(arrays)


def true_world(name, frames, mia_skin):
    take = marker_takes.TAKES[name]()
    times = marker_takes.marker_times(take)[frames]
    quaternion, translation = marker_takes.head(take, times)
    turns = transform.Rotation.from_quat(quaternion).as_matrix()
    still, _ = capture.true_markers(*mia_skin, marker_takes.expression(take, times))
    return capture.in_system(markers.moved(still, turns, translation))


@pytest.mark.parametrize("name", marker_takes.TAKES)
def test_another_reader_finds_102_markers_at_120_hz_in_millimetres(name):
    point, points = read(name)
    assert point["RATE"]["value"] == [RATE]
    assert point["UNITS"]["value"] == ["mm"]
    assert point["LABELS"]["value"] == [f"mia:{name}" for name in markers.NAMES]
    assert len(set(markers.NAMES)) == points.shape[1] == 102
    assert len(points) == marker_takes.TAKES[name]().frames


@pytest.mark.parametrize("name", marker_takes.TAKES)
def test_what_is_missing_is_what_the_truth_says(name):
    _, points = read(name)
    missing = np.isnan(points).any(axis=2)
    expected = np.zeros_like(missing)
    for line in known(name)["gaps"]:
        marker, first, count = str(line).split()
        expected[int(first) : int(first) + int(count), markers.NAMES.index(marker)] = True
    assert (missing == expected).all()
    assert 0.0005 < missing.mean() < 0.01


@pytest.mark.parametrize("name", marker_takes.TAKES)
def test_markers_are_the_true_ones_but_for_noise_gaps_and_faults(name, mia_skin):
    _, points = read(name)
    frames = np.arange(0, len(points), STEP)
    off = points[frames] - true_world(name, frames, mia_skin)
    wrong = np.zeros(off.shape[:2], bool)
    for _, names, first, count, _ in marker_takes.faults(marker_takes.TAKES[name]()):
        during = (frames >= first) & (frames < first + count)
        for marker in names:
            wrong[during, markers.NAMES.index(marker)] = True
    assert 0.13 < np.sqrt(np.nanmean(off[~wrong] ** 2)) < 0.17
    assert np.nanmax(np.abs(off[~wrong])) < 1.0
    if name == "capture":
        assert wrong.any()
        assert np.nanmin(np.linalg.norm(off[wrong], axis=1)) > 5


def test_faults_last_about_half_a_second_and_move_markers_by_a_centimetre_or_two():
    faults = marker_takes.faults(marker_takes.capture())
    assert [kind for kind, *_ in faults] == ["jump", "swap"]
    for kind, _, _, count, by in faults:
        assert 0.3 < count / RATE < 0.7
        if kind == "jump":
            assert 10 < np.linalg.norm(by) < 20


def test_the_film_starts_seven_tenths_after_the_markers_by_its_sound():
    sounds = []
    for file in ("capture.mp4", "capture.flac"):
        with av.open(str(HERE / file)) as container:
            resampler = av.AudioResampler("flt", "mono", SOUND_RATE)
            blocks = [
                part.to_ndarray()[0]
                for frame in container.decode(audio=0)
                for part in resampler.resample(frame)
            ]
        sounds.append(np.concatenate(blocks))
    film, system = (np.diff(s) for s in sounds)
    match = signal.correlate(film, system, method="fft")
    lag = np.argmax(match) - (len(system) - 1)
    assert abs(lag / SOUND_RATE - marker_takes.OFFSET_S) < 0.002
    others = np.abs(np.delete(match, np.arange(np.argmax(match) - 80, np.argmax(match) + 80)))
    assert match.max() > 2 * others.max()
    assert float(known("capture")["offset_s"]) == marker_takes.OFFSET_S == pytest.approx(-0.7, 0.01)


def test_markers_and_their_sound_begin_before_the_film_and_end_after_it():
    with av.open(str(HERE / "capture.mp4")) as container:
        picture = container.streams.video[0]
        assert picture.codec_context.name == "h264"
        assert container.streams.audio[0].codec_context.name == "aac"
        assert picture.average_rate == 30
        assert picture.width == picture.height == capture.PICTURE
        count = sum(packet.pts is not None for packet in container.demux(picture))
    assert count == round(marker_takes.FILM_S * 30)
    take = marker_takes.capture()
    assert take.frames / RATE + take.offset_s > marker_takes.FILM_S
    with av.open(str(HERE / "capture.flac")) as container:
        samples = sum(frame.samples for frame in container.decode(audio=0))
    assert samples / SOUND_RATE == pytest.approx(take.frames / RATE, abs=0.001)


def test_phones_are_the_true_ones_and_cover_all_visemes_in_every_expression():
    grid = textgrid.openTextgrid(str(HERE / "capture.TextGrid"), includeEmptyIntervals=True)
    kept = known("capture")
    start = kept["phone_start_s"] - kept["offset_s"]
    entries = [entry for entry in grid.getTier("phones").entries if entry.label != "pau"]
    spoken_ones = kept["phones"] != "pau"
    assert [entry.label for entry in entries] == kept["phones"][spoken_ones].tolist()
    np.testing.assert_allclose([e.start for e in entries], start[spoken_ones], atol=1e-3)
    visemes = {name: i for i, group in enumerate(tuned_pairs.VISEMES) for name in group.split()}
    assert {visemes[name] for name in kept["phones"]} == set(range(15))
    said = spoken.phones()
    for sentence in marker_cues.SENTENCES:
        assert len({visemes[phone.name] for phone in said[sentence]}) >= 11


def test_the_transcript_has_the_words_of_the_grid():
    grid = textgrid.openTextgrid(str(HERE / "capture.TextGrid"), includeEmptyIntervals=True)
    words = [entry.label for entry in grid.getTier("words").entries if entry.label]
    assert (HERE / "capture.txt").read_text(encoding="utf-8").split() == words
    assert len(words) > 25


def test_the_neutral_frame_is_neutral_and_its_head_stands_still():
    take = marker_takes.capture()
    times = tuned_pairs.NEUTRAL / RATE + np.linspace(-0.1, 0.08, 5)
    assert np.abs(marker_takes.expression(take, times)).max() < 1e-9
    quaternion, translation = marker_takes.head(take, times)
    np.testing.assert_allclose(np.abs(quaternion[:, 3]), 1, atol=1e-9)
    np.testing.assert_allclose(translation, 0, atol=1e-9)


def test_the_head_moves_and_the_eyes_blink():
    kept = known("capture")
    turned = transform.Rotation.from_quat(kept["quaternion"]).magnitude()
    assert 12 < np.rad2deg(turned.max()) < 30
    blink = kept["expression"][:, params.NAMES.index("blink_r")] > 0.95
    assert np.count_nonzero(np.diff(blink.astype(int)) == 1) == len(marker_cues.CAPTURE_BLINKS)


@pytest.mark.parametrize("name", marker_takes.TAKES)
def test_truth_is_made_again_from_its_seeds(name, mia_skin):
    kept, made = known(name), marker_truth.of_take(name, *mia_skin)
    assert set(kept) == set(made)
    for key, value in made.items():
        if value.dtype.kind == "f":
            np.testing.assert_allclose(kept[key], value, atol=2e-3)
        else:
            assert (kept[key] == value).all()


def test_line_is_made_again_byte_by_byte(tmp_path):
    capture.write_all(tmp_path, ["line"])
    for name in ("capture/line.c3d", "truth/line.npz"):
        assert (tmp_path / name).read_bytes() == (FOLDER / name).read_bytes()
