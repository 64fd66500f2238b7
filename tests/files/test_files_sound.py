import wave
from fractions import Fraction

import av
import numpy as np
import pytest

from stages.files import errors, sound

RATE = 8000


def clicks(rate, seconds=1.5, at=(0.25, 0.5, 1.0)):
    """Short tones of 1 kHz, each around one time."""
    time = np.arange(round(rate * seconds)) / rate
    tones = [np.exp(-(((time - t) * 1500) ** 2)) * np.cos(2000 * np.pi * (time - t)) for t in at]
    return 0.8 * np.sum(tones, axis=0)


def lateness(samples, start_s, at=(0.25, 0.5, 1.0)):
    """How much later than they should the tones sound [s], by the phase of each."""
    time = start_s + np.arange(len(samples)) / RATE
    late = []
    for t in at:
        near = np.abs(time - t) < 0.01
        turned = np.sum(samples[near] * np.exp(-2000j * np.pi * (time[near] - t)))
        late.append(-np.angle(turned) / (2000 * np.pi))
    return np.array(late)


def write_wav(path, channels, rate=48000, width=2):
    """Write (C, N) samples without PyAV."""
    with wave.open(str(path), "wb") as file:
        file.setparams((len(channels), width, rate, 0, "NONE", ""))
        file.writeframes((np.transpose(channels) * 32767).astype("<i2").tobytes())
    return path


def write_film(path, sound_start_s=0.0, picture_start_s=0.0, rate=44100, samples=None, pause_at=()):
    """Write a film; `pause_at` leaves out blocks of 1,024 samples of the sound."""
    samples = clicks(rate) if samples is None else samples
    codec = "pcm_s16le" if path.suffix == ".mkv" else "aac"
    with av.open(str(path), "w") as container:
        video = container.add_stream("libx264", rate=30)
        video.width, video.height, video.pix_fmt = 64, 48, "yuv420p"
        audio = container.add_stream(codec, rate=rate, layout="mono")
        for number in range(45):
            picture = av.VideoFrame.from_ndarray(np.zeros((48, 64, 3), np.uint8), format="rgb24")
            picture.pts, picture.time_base = number + round(picture_start_s * 30), Fraction(1, 30)
            container.mux(video.encode(picture))
        container.mux(video.encode())
        for block in range(-(-len(samples) // 1024)):
            if block in pause_at:
                continue
            values = samples[None, block * 1024 : (block + 1) * 1024]
            if codec == "aac":
                frame = av.AudioFrame.from_ndarray(values.astype(np.float32), "fltp", "mono")
            else:
                frame = av.AudioFrame.from_ndarray((values * 32767).astype(np.int16), "s16", "mono")
            frame.sample_rate, frame.time_base = rate, Fraction(1, rate)
            frame.pts = block * 1024 + round(sound_start_s * rate)
            container.mux(audio.encode(frame))
        container.mux(audio.encode())
    return path


def test_a_wav_of_the_same_rate_comes_as_it_is(tmp_path):
    written = clicks(RATE)
    samples, start_s = sound.read(write_wav(tmp_path / "a.wav", [written], RATE), RATE)
    assert start_s == 0
    assert samples.dtype == np.float32
    np.testing.assert_allclose(samples, written, atol=1e-4)


@pytest.mark.parametrize("rate", [44100, 48000, 16000])
def test_other_rates_keep_time_and_length(tmp_path, rate):
    samples, start_s = sound.read(write_wav(tmp_path / "a.wav", [clicks(rate)], rate), RATE)
    assert abs(len(samples) - 1.5 * RATE) <= 2
    assert np.abs(lateness(samples, start_s)).max() < 1e-6


def test_channels_are_averaged(tmp_path):
    left, right = clicks(RATE, at=(0.25,)), clicks(RATE, at=(1.0,))
    path = write_wav(tmp_path / "a.wav", [left, right], RATE)
    np.testing.assert_allclose(sound.read(path, RATE)[0], (left + right) / 2, atol=1e-4)


@pytest.mark.parametrize("name", ["a.mp4", "a.mkv"])
@pytest.mark.parametrize(("sound_s", "picture_s"), [(0.0, 0.0), (0.3, 0.0), (0.0, 0.3)])
def test_a_films_sound_is_on_the_clock_of_its_pictures(tmp_path, name, sound_s, picture_s):
    path = write_film(tmp_path / name, sound_s, picture_s)
    samples, start_s = sound.read(path, RATE)
    # AAC may begin with what its encoder put before, and says so in its times
    assert abs(start_s - sound_s + picture_s) < 0.03
    late = lateness(samples, start_s - sound_s + picture_s)
    assert np.abs(late).max() < 6e-4


def test_a_pause_in_the_times_becomes_silence(tmp_path):
    path = write_film(tmp_path / "a.mkv", rate=8000, pause_at=(5, 6))
    samples, start_s = sound.read(path, RATE)
    assert np.abs(samples[5 * 1024 + 64 : 7 * 1024 - 64]).max() == 0
    assert np.abs(lateness(samples, start_s, at=(0.25, 0.5, 1.0))).max() < 6e-4


def test_a_cover_is_no_picture(tmp_path):
    path = tmp_path / "a.mp4"
    with av.open(str(path), "w") as container:
        audio = container.add_stream("aac", rate=44100, layout="mono")
        cover = container.add_stream("mjpeg", rate=1)
        cover.width, cover.height, cover.pix_fmt = 64, 48, "yuvj420p"
        cover.disposition = av.stream.Disposition.attached_pic
        picture = av.VideoFrame.from_ndarray(np.zeros((48, 64, 3), np.uint8), format="rgb24")
        picture.pts, picture.time_base = 5, Fraction(1, 1)
        values = clicks(44100).astype(np.float32)[None]
        frame = av.AudioFrame.from_ndarray(values, "fltp", "mono")
        frame.sample_rate, frame.pts, frame.time_base = 44100, 13230, Fraction(1, 44100)
        container.mux(cover.encode(picture))
        container.mux([*audio.encode(frame), *audio.encode(), *cover.encode()])
    assert sound.read(path, RATE)[1] == 0


def refusal(path):
    with pytest.raises(errors.InputError) as error:
        sound.read(path, RATE)
    message = str(error.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    return message


def test_what_holds_no_sound_is_refused_in_one_line(tmp_path):
    assert "no such sound" in refusal(tmp_path / "a.wav")
    (tmp_path / "text.wav").write_bytes(b"no sound at all" * 100)
    assert "cannot be decoded" in refusal(tmp_path / "text.wav")
    (tmp_path / "nothing.wav").write_bytes(b"")
    assert "cannot be decoded" in refusal(tmp_path / "nothing.wav")
    assert "sound is empty" in refusal(write_wav(tmp_path / "empty.wav", np.zeros((1, 0)), RATE))
    mute = tmp_path / "mute.mp4"
    with av.open(str(mute), "w") as container:
        stream = container.add_stream("libx264", rate=30)
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
        picture = av.VideoFrame.from_ndarray(np.zeros((48, 64, 3), np.uint8), format="rgb24")
        container.mux([*stream.encode(picture), *stream.encode()])
    assert "has no sound" in refusal(mute)


def test_samples_that_are_no_numbers_and_times_that_jump_are_refused(tmp_path):
    path = tmp_path / "nan.wav"
    values = clicks(RATE).astype(np.float32)
    values[4000] = np.nan
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_f32le", rate=RATE, layout="mono")
        frame = av.AudioFrame.from_ndarray(values[None], "flt", "mono")
        frame.sample_rate = RATE
        container.mux([*stream.encode(frame), *stream.encode()])
    assert "no numbers" in refusal(path)
    path = tmp_path / "jump.mkv"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=RATE, layout="mono")
        for start in (0, 1024, 3 * 10**7):
            frame = av.AudioFrame.from_ndarray(np.ones((1, 1024), np.int16), "s16", "mono")
            frame.sample_rate, frame.pts, frame.time_base = RATE, start, Fraction(1, RATE)
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
    assert "jump by 3750 s after 0.26 s" in refusal(path)
