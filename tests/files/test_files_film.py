from fractions import Fraction

import av
import numpy as np
import pytest

from stages.files import errors, film


def write_film(path, count=40, rate=30, size=(64, 48), faststart=False):
    options = {"movflags": "faststart"} if faststart else {}
    with av.open(str(path), "w", options=options) as container:
        stream = container.add_stream("libx264", rate=rate)
        stream.width, stream.height = size
        stream.pix_fmt = "yuv420p"
        rng = np.random.default_rng(0)
        for number in range(count):
            picture = np.full((size[1], size[0], 3), 2 * number, np.uint8)
            picture[:8] = rng.integers(0, 255, (8, size[0], 3))
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode())
    return path


def test_pictures_and_times_come_in_order_from_zero(tmp_path):
    path = write_film(tmp_path / "a.mp4", rate=Fraction(30000, 1001))
    frames = list(film.read_frames(path))
    assert len(frames) == 40 == film.promised_count(path)
    np.testing.assert_allclose(
        [time for time, _ in frames], np.arange(40) * 1001 / 30000, atol=1e-4
    )
    levels = [picture[30:].mean() for _, picture in frames]
    np.testing.assert_allclose(levels, 2 * np.arange(40), atol=3)
    assert film.nominal_rate(path) == Fraction(30000, 1001)
    assert film.size(path) == (64, 48)


def test_single_frames_and_one_beyond_the_end(tmp_path):
    path = write_film(tmp_path / "a.mp4")
    assert abs(film.frames_at(path, [7, 31], "labels.csv")[31][30:].mean() - 62) < 3
    with pytest.raises(
        errors.InputError, match=r"labels\.csv: frame 40 does not exist: .* frame 39"
    ):
        film.frames_at(path, [40], "labels.csv")


@pytest.mark.parametrize("faststart", [False, True])
def test_a_film_cut_short_is_refused(tmp_path, faststart):
    whole = write_film(tmp_path / "a.mp4", count=90, faststart=faststart).read_bytes()
    path = tmp_path / "cut.mp4"
    path.write_bytes(whole[: int(len(whole) * 0.7)])
    with pytest.raises(errors.InputError, match=r"cut\.mp4: (is cut short|cannot be)"):
        list(film.read_frames(path))


def test_what_is_no_film_is_refused(tmp_path):
    path = tmp_path / "a.mp4"
    with pytest.raises(errors.InputError, match="no such film"):
        film.nominal_rate(path)
    path.write_bytes(b"no film at all" * 100)
    with pytest.raises(errors.InputError, match="cannot be opened"):
        film.size(path)
    with av.open(str(tmp_path / "a.wav"), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=8000)
        sound = av.AudioFrame.from_ndarray(np.zeros((1, 800), np.int16), layout="mono")
        sound.sample_rate = 8000
        container.mux(stream.encode(sound))
    with pytest.raises(errors.InputError, match="no picture stream"):
        list(film.read_frames(tmp_path / "a.wav"))


def test_a_picture_that_changes_size_is_refused(tmp_path):
    parts = []
    for index, size in enumerate([(64, 48), (80, 48)]):
        raw = tmp_path / f"{index}.m2v"
        with av.open(str(raw), "w") as container:
            stream = container.add_stream("mpeg2video", rate=25)
            stream.width, stream.height = size
            stream.pix_fmt = "yuv420p"
            for _ in range(10):
                picture = np.zeros((size[1], size[0], 3), np.uint8)
                container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
            container.mux(stream.encode())
        parts.append(raw.read_bytes())
    path = tmp_path / "both.m2v"
    path.write_bytes(b"".join(parts))
    with pytest.raises(errors.InputError, match="changes the picture's size from 64x48 to 80x48"):
        list(film.read_frames(path))


@pytest.mark.parametrize("rate", [25, Fraction(30000, 1001)])
def test_the_last_pictures_time_is_known_without_decoding(tmp_path, rate):
    path = write_film(tmp_path / "a.mp4", rate=rate)
    *_, (decoded, _) = film.read_frames(path)
    assert film.last_time(path) == pytest.approx(decoded, abs=1e-9)
    cut = tmp_path / "cut.mp4"
    whole = write_film(tmp_path / "b.mp4", count=90, faststart=True).read_bytes()
    cut.write_bytes(whole[: int(len(whole) * 0.7)])
    with pytest.raises(errors.InputError, match=r"cut\.mp4: is cut short"):
        film.last_time(cut)
