from fractions import Fraction

import av
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.files import errors, film_writer, sound, sound_pieces, sound_writer, tempo_text

RATE = 24000
SECONDS = 6.0
PERIOD_S, BURST_S = 1.0, 0.12
TEMPOS = [Fraction(1, 4), Fraction(1, 2), Fraction(4, 5), Fraction(24, 25), Fraction(3, 2), 2, 3]


def bursts(pitch=330.0):
    """Return a tone that sounds once a second, in the middle of it."""
    time = np.arange(int(SECONDS * RATE)) / RATE
    near = np.abs(time % PERIOD_S - PERIOD_S / 2) < BURST_S / 2
    return (0.5 * near * np.sin(2 * np.pi * pitch * time)).astype(np.float32)


def played(samples, tempo, block=1000):
    """Return (C, N) samples at a tempo."""
    planes = np.atleast_2d(samples)
    layout = "mono" if len(planes) == 1 else "stereo"
    starts = range(0, planes.shape[1], block)
    pieces = ((RATE, layout, start, planes[:, start : start + block]) for start in starts)
    made = list(sound_pieces.at_tempo(pieces, Fraction(tempo)))
    ends = np.cumsum([piece[3].shape[1] for piece in made])
    assert [piece[2] for piece in made] == [0, *ends[:-1]]
    return np.concatenate([piece[3] for piece in made], axis=1)


def write_wav(path, planes, rate=RATE):
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=rate, layout="mono")
        whole = (np.atleast_2d(planes) * 32767).astype(np.int16)
        frame = av.AudioFrame.from_ndarray(whole, format="s16", layout="mono")
        frame.sample_rate = rate
        container.mux(stream.encode(frame))
        container.mux(stream.encode())


@pytest.mark.parametrize("tempo", TEMPOS)
def test_every_burst_comes_when_it_should_at_its_own_pitch(tempo):
    made = played(bursts(), tempo)[0]
    assert len(made) == round(SECONDS * RATE / tempo)
    period = float(PERIOD_S / Fraction(tempo))
    time = np.arange(len(made)) / RATE
    for number in range(int(SECONDS)):
        inside = (time >= number * period) & (time < (number + 1) * period)
        power = made[inside] ** 2
        middle = np.sum(power * time[inside]) / power.sum()
        assert abs(middle - (number + 0.5) * period) < 0.004 + 0.008 / tempo
    loud = np.abs(np.fft.rfft(made * np.hanning(len(made))))
    pitch = np.fft.rfftfreq(len(made), 1 / RATE)[np.argmax(loud)]
    assert pitch == pytest.approx(330, rel=0.02)


def test_two_channels_stay_two():
    both = np.stack([bursts(330), bursts(495)])
    made = played(both, Fraction(5, 4))
    assert made.shape == (2, round(SECONDS * RATE / 1.25))
    for row, pitch in zip(made, (330, 495), strict=True):
        loud = np.abs(np.fft.rfft(row))
        found = np.fft.rfftfreq(len(row), 1 / RATE)[np.argmax(loud)]
        assert found == pytest.approx(pitch, rel=0.02)


@settings(max_examples=15, deadline=None)
@given(st.integers(1, 30000), st.fractions(Fraction(1, 4), 4, max_denominator=50))
def test_the_length_is_that_of_the_sound_over_the_tempo(count, tempo):
    made = played(np.ones(count), tempo)
    assert made.shape == (1, round(count / tempo))


def test_gaps_become_silence_and_overlaps_are_cut():
    ones = np.ones((1, 10), np.float32)
    pieces = [(RATE, "mono", start, number * ones) for number, start in enumerate((-4, 8, 12), 1)]
    made = list(sound_pieces.seamless(pieces))
    joined = np.concatenate([piece[3] for piece in made], axis=1)[0]
    np.testing.assert_array_equal(joined, [1] * 6 + [0] * 2 + [2] * 10 + [3] * 4)
    assert [piece[2] for piece in made] == [0, 6, 18]


@pytest.mark.parametrize("name", ["a.wav", "a.flac"])
def test_a_written_sound_is_read_again(tmp_path, name):
    write_wav(tmp_path / "in.wav", bursts())
    seconds = sound_writer.write(tmp_path / name, tmp_path / "in.wav", Fraction(1))
    assert seconds == SECONDS
    samples, start = sound.read(tmp_path / name, RATE)
    assert start == 0
    np.testing.assert_allclose(samples, bursts(), atol=2 / 32767)
    again = tmp_path / f"again{name[1:]}"
    sound_writer.write(again, tmp_path / "in.wav", Fraction(1))
    assert again.read_bytes() == (tmp_path / name).read_bytes()


def test_a_film_plays_its_sound_at_the_tempo(tmp_path):
    write_wav(tmp_path / "in.wav", bursts())
    picture = np.zeros((48, 64, 3), np.uint8)
    slow = [(number / 10, picture) for number in range(90)]
    film = tmp_path / "slow.mp4"
    film_writer.write(film, slow, (64, 48), Fraction(10), tmp_path / "in.wav", 0.0, Fraction(2, 3))
    samples, _ = sound.read(film, RATE)
    assert len(samples) / RATE == pytest.approx(9, abs=0.1)
    time = np.arange(len(samples)) / RATE
    third = (time > 3) & (time < 4.5)
    middle = np.sum(samples[third] ** 2 * time[third]) / np.sum(samples[third] ** 2)
    assert middle == pytest.approx(3.75, abs=0.03)


def test_a_silent_film_gives_silence(tmp_path):
    picture = np.zeros((48, 64, 3), np.uint8)
    film_writer.write(
        tmp_path / "a.mp4", ((n / 10, picture) for n in range(20)), (64, 48), Fraction(10)
    )
    seconds = sound_writer.write(tmp_path / "a.wav", tmp_path / "a.mp4", Fraction(1, 2))
    assert seconds == pytest.approx(4)
    samples, _ = sound.read(tmp_path / "a.wav", 48000)
    assert len(samples) == 4 * 48000
    assert not samples.any()


def test_what_is_no_sound_is_refused(tmp_path):
    with pytest.raises(errors.InputError, match="no such sound"):
        sound_writer.write(tmp_path / "a.wav", tmp_path / "none.wav", Fraction(1))
    with pytest.raises(errors.InputError, match="written as .wav or .flac"):
        sound_writer.write(tmp_path / "a.mp3", tmp_path / "none.wav", Fraction(1))
    (tmp_path / "bad.wav").write_bytes(b"no sound at all")
    with pytest.raises(errors.InputError, match="cannot be decoded"):
        sound_writer.write(tmp_path / "a.wav", tmp_path / "bad.wav", Fraction(2))
    write_wav(tmp_path / "short.wav", np.zeros(1))
    with pytest.raises(errors.InputError, match=r"short\.wav: holds no sound from"):
        sound_writer.write(tmp_path / "a.wav", tmp_path / "short.wav", Fraction(2))
    assert not (tmp_path / "a.wav").exists()


@pytest.mark.parametrize(
    "text", ["", "0", "-1", "5", "fast", "1/0", "1.234567", "nan", "inf", "1e9999999"]
)
def test_other_tempos_are_refused(text):
    with pytest.raises(errors.InputError, match=r"--tempo: '.*' is no tempo from 1/4 to 4"):
        tempo_text.read("--tempo", text)


def test_tempos_are_exact():
    assert tempo_text.read("--tempo", "1.1") == Fraction(11, 10)
    assert tempo_text.read("--tempo", " 24/25 ") == Fraction(24, 25)
