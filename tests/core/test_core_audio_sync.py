import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import audio_sync, line_fit, sound_matching, spectral_whitening

RATE = 8000


def speech(seconds, seed):
    """Bursts of coloured noise, four a second, with pauses: no two seeds are alike."""
    rng = np.random.default_rng(seed)
    count = round(seconds * RATE)
    syllables = rng.random(round(seconds * 4) + 2) * (rng.random(round(seconds * 4) + 2) < 0.7)
    envelope = np.interp(np.arange(count) / RATE * 4, np.arange(len(syllables)), syllables)
    colour = np.convolve(rng.standard_normal(count), [1, 1.5, 0.8], "same")
    return 0.1 * envelope * colour


def at_times(sound, time_s):
    """Take a band-limited sound at any times, from eight times as many samples."""
    fine = np.fft.irfft(np.fft.rfft(sound), 8 * len(sound)) * 8
    return np.interp(time_s * 8 * RATE, np.arange(len(fine)), fine, left=0, right=0)


def noisy(sound, decibels, seed):
    noise = np.random.default_rng([seed, 1]).standard_normal(len(sound))
    return sound + noise * np.sqrt(np.mean(sound**2)) * 10 ** (-decibels / 20)


def hum(count, seed):
    rng, time = np.random.default_rng(seed), np.arange(count) / RATE
    return sum(np.sin(2 * np.pi * 50 * k * time + rng.uniform(0, 7)) for k in range(1, 30))


@settings(max_examples=8, deadline=None)
@given(shift=st.floats(-3.0, 3.0), seed=st.integers(0, 10**6))
def test_any_shift_is_found_between_samples(shift, seed):
    mocap = speech(6, seed)
    video = at_times(mocap, np.arange(6 * RATE) / RATE - shift)
    found = audio_sync.synchronise(noisy(mocap, 10, 1), noisy(video, 10, 2), RATE)
    assert not found.reason
    assert found.confidence > 0.6
    assert abs(found.offset_s - shift) < 1e-4
    assert found.drift == 0
    assert np.isnan(found.drift_error)


def test_drift_and_offset_of_a_long_take():
    mocap, drift = speech(54, 3), 145e-6
    video = at_times(mocap, (np.arange(50 * RATE) / RATE - 2.321) / (1 + drift))
    found = audio_sync.synchronise(noisy(mocap, 0, 1), noisy(video, 0, 2), RATE)
    assert abs(found.offset_s - 2.321) < 5e-4
    assert abs(found.drift - drift) < min(5e-6, 5 * found.drift_error)
    back = audio_sync.synchronise(noisy(video, 0, 2), noisy(mocap, 0, 1), RATE)
    # the inverse of t = (1 + d) s + o
    assert abs((1 + back.drift) * (1 + found.drift) - 1) < 1e-9
    assert abs(back.offset_s + found.offset_s / (1 + found.drift)) < 1e-6


def test_overlap_of_a_part_is_enough():
    whole = speech(20, 5)
    found = audio_sync.synchronise(whole[: 12 * RATE], whole[9 * RATE :], RATE)
    assert abs(found.offset_s + 9) < 1e-4


def test_hum_of_ten_times_the_speech_and_noise_do_not_matter():
    mocap, video = speech(6, 7), speech(9, 8)
    video[RATE : 7 * RATE] = mocap
    level = 10 * np.sqrt(np.mean(mocap**2)) / np.sqrt(14.5)
    loud = [
        noisy(sound, 10, k) + level * hum(len(sound), k) for k, sound in ((1, mocap), (2, video))
    ]
    found = audio_sync.synchronise(*loud, RATE)
    assert abs(found.offset_s - 1) < 1e-4


@pytest.mark.parametrize("seconds", [3, 8])
def test_other_takes_are_refused(seconds):
    for seed in range(5):
        pair = noisy(speech(seconds, seed), 10, 1), noisy(speech(seconds, seed + 100), 10, 2)
        found = audio_sync.synchronise(*pair, RATE)
        assert found.reason == "no common sound found"
        assert np.isnan(found.offset_s)


def test_the_same_vowel_alone_does_not_make_a_match():
    mocap, video = speech(6, 1), speech(6, 2)
    video[RATE : RATE + 1000] = mocap[3 * RATE : 3 * RATE + 1000] = speech(1, 3)[:1000]
    assert audio_sync.synchronise(mocap, video, RATE).reason == "no common sound found"


def test_silence_steady_noise_and_short_sounds_are_refused_by_name():
    sound, silence = speech(4, 1), np.zeros(4 * RATE)
    dither = 1e-5 * np.random.default_rng(0).standard_normal(4 * RATE)
    reasons = [
        audio_sync.synchronise(mocap, video, RATE).reason
        for mocap, video in (
            (silence, sound),
            (sound, dither + 0.3),
            (sound, 1000 * dither),
            (hum(4 * RATE, 1), sound),
            (sound, sound[:4000]),
            (sound[:0], sound),
        )
    ]
    assert reasons == [
        "the mocap's sound is silent",
        "the camera's sound is silent",
        "no common sound found",
        "no common sound found",
        "the camera's sound is too short: 0.50 s",
        "the mocap's sound is too short: 0.00 s",
    ]


@pytest.mark.parametrize(("lost", "reason"), [(0.05, "sound is missing"), (1.5, "at two places")])
def test_a_recording_with_a_piece_missing_is_refused(lost, reason):
    mocap = speech(32, 4)
    video = np.delete(mocap, np.s_[20 * RATE : round((20 + lost) * RATE)])
    found = audio_sync.synchronise(mocap, video, RATE)
    assert found.reason.startswith("chunks disagree: ")
    assert reason in found.reason


def test_what_is_no_sound_raises():
    sound = speech(2, 1)
    with pytest.raises(ValueError, match=r"\(2, 8000\)"):
        audio_sync.synchronise(sound.reshape(2, -1), sound, RATE)
    with pytest.raises(ValueError, match="4000 Hz"):
        audio_sync.synchronise(sound, sound, 4000)


def test_whitening_does_not_know_loudness_and_silences_hum():
    sound = speech(4, 1)
    whitened = spectral_whitening.whiten(sound, RATE)
    assert len(whitened) == len(sound)
    np.testing.assert_allclose(spectral_whitening.whiten(1000 * sound, RATE), whitened, atol=1e-5)
    loud = sound + 10 * sound.std() / np.sqrt(14.5) * hum(4 * RATE, 1)
    assert np.corrcoef(sound, loud)[0, 1] < 0.15
    assert np.corrcoef(whitened, spectral_whitening.whiten(loud, RATE))[0, 1] > 0.6
    spectrum = np.abs(np.fft.rfft(whitened))
    frequency = np.fft.rfftfreq(len(sound), 1 / RATE)
    outside = (frequency < 150) | (frequency > 3450)
    assert spectrum[outside].max() < 0.05 * spectrum.max()


def test_search_agrees_with_correlating_directly():
    rng = np.random.default_rng(1)
    one, other = (rng.standard_normal(count).astype(np.float32) for count in (9000, 60000))
    other[30000:34000] += one[:4000]
    sounds = sound_matching.cut(one, other, 1000)._replace(starts=np.array([0, 4500]))
    found = sound_matching.search(sounds)
    best = [found.lag[found.chunk == chunk][0] for chunk in (0, 1)]
    direct = np.correlate(other, one[: sounds.length], "valid")
    assert best[0] == direct.argmax() == 30000
    # scores of unrelated sounds have a standard deviation of one
    correlation, variance = sound_matching.around(sounds, 4500, 20000, 2000)
    assert 0.9 < correlation.std() / np.sqrt(variance) < 1.1
    place = 4500 + 20000 + 7
    expected = np.dot(one[4500 : 4500 + sounds.length], other[place : place + sounds.length])
    np.testing.assert_allclose(correlation[2007], expected, rtol=1e-3, atol=0.1)
    np.testing.assert_allclose(
        sound_matching.pieces(sounds, 4500, 20007).sum(), expected, rtol=1e-3, atol=0.1
    )


def test_a_line_through_points_of_which_a_third_is_far_off():
    rng = np.random.default_rng(2)
    x = rng.uniform(0, 600, 90)
    y = 0.3 + 2e-4 * x + 1e-4 * rng.standard_normal(90)
    y[::3] += rng.uniform(-1, 1, 30)
    line = line_fit.robust(x, y, np.ones(90), True, 1e-6)
    assert abs(line.slope - 2e-4) < 4 * line.slope_error < 1e-6
    assert abs(line.at(0.0) - 0.3) < 1e-4
    flat = line_fit.robust(x, np.where(np.arange(90) % 3, 5.0, y), np.ones(90), False, 1e-6)
    assert (flat.level, flat.slope, flat.slope_error) == (5.0, 0.0, np.inf)
    with pytest.raises(ValueError, match=r"\(0,\)"):
        line_fit.robust(x[:0], y[:0], y[:0], True, 1e-6)


def test_an_echo_as_loud_as_the_direct_sound_is_refused():
    whole = speech(6, 9)
    echoed = whole.copy()
    echoed[400:] += whole[:-400]
    found = audio_sync.synchronise(whole, echoed, RATE)
    assert found.reason == "too much echo to tell the direct sound"
    echoed[400:] -= 0.5 * whole[:-400]
    assert abs(audio_sync.synchronise(whole, echoed, RATE).offset_s) < 1e-4
