import hypothesis
import hypothesis.strategies as st
import numpy as np
import pytest

from stages.core import kept_moments, motion_events, motion_filter

CLOSING_S, HELD_S, OPENING_S = 0.07, 0.02, 0.12
BLINKS_S = (1.0, 2.2, 3.0, 4.7, 6.1)
SECONDS = 8.0
NAMES = ["face.eyeBlinkLeft", "face.jawOpen", "face.mouthSmile_L", "face.browInnerUp"]


def clock(rate, seconds=SECONDS):
    return np.arange(int(seconds * rate)) / rate


def blink(since):
    """A blink that begins at 0: a weight from 0 to 1 and back."""
    closing = np.clip(since / CLOSING_S, 0, 1)
    opening = np.clip((since - CLOSING_S - HELD_S) / OPENING_S, 0, 1)
    return 0.5 * (np.cos(np.pi * opening) - np.cos(np.pi * closing))


def blinking(rate, starts=BLINKS_S, height=0.8):
    time = clock(rate)
    base = 0.1 + 0.05 * np.sin(2 * np.pi * 0.3 * time)
    return base + height * sum(blink(time - start) for start in starts)


def jittered(curve, seed, size=0.02):
    noise = size * np.random.default_rng(seed).standard_normal(len(curve))
    return (curve + noise)[:, None]


def at_their_height(rate, starts=BLINKS_S):
    return [round((start + CLOSING_S + HELD_S / 2) * rate) for start in starts]


def kept(values, rate, names=NAMES[:1], gap=None, cutoff=10.0):
    events = kept_moments.find(values, names, [""] * len(names), rate, gap)
    return motion_filter.filtered(values, rate, np.full(len(names), cutoff), events), events


@pytest.mark.parametrize("rate", [30, 50, 60, 120, 240])
def test_planted_blinks_keep_their_depth(rate):
    truth, frames = blinking(rate), at_their_height(rate)
    depths = []
    for seed in range(6):
        made, _ = kept(jittered(truth, seed), rate)
        depths.append(1 - (truth - made[:, 0])[frames] / 0.8)
    assert np.mean(depths) >= 0.95
    assert np.min(np.mean(depths, axis=0)) >= 0.93


@pytest.mark.parametrize("rate", [60, 120])
def test_blinks_are_deeper_than_without_events_and_jitter_goes(rate):
    truth = blinking(rate)
    noisy = jittered(truth, 1)
    made, events = kept(noisy, rate)
    plain = motion_filter.filtered(noisy, rate, np.array([10.0]), np.zeros_like(noisy))
    frames = at_their_height(rate)
    assert made[frames].mean() > plain[frames].mean() + 0.01
    calm = events[:, 0] == 0
    # between events the two are the same filter
    np.testing.assert_array_equal(made[calm], plain[calm])
    assert 0.5 < calm.mean() < 0.9
    rough = [np.diff(curve[:, 0] - truth, 2).var() for curve in (noisy, made)]
    assert rough[1] < 0.2 * rough[0]


@pytest.mark.parametrize("rate", [60, 120])
def test_every_blink_is_found_and_nothing_else(rate):
    for seed in range(4):
        found = motion_events.excursions(jittered(blinking(rate), seed), rate)[:, 0]
        frames = at_their_height(rate)
        assert found[frames].all()
        near = np.abs(np.flatnonzero(found)[:, None] - np.array(frames)).min(axis=1)
        assert near.max() < 0.2 * rate


@pytest.mark.parametrize("rate", [30, 60, 120])
@pytest.mark.parametrize("size", [1e-4, 0.02, 5.0])
def test_noise_alone_has_no_events(rate, size):
    rng = np.random.default_rng(int(rate))
    noise = 0.3 + size * rng.standard_normal((6000, 12))
    assert not motion_events.excursions(noise, rate).any()
    # neither where the weights are cut off at zero half of the time
    assert not motion_events.excursions(np.maximum(noise - 0.3, 0), rate).any()
    gap = 5 + size * rng.standard_normal(6000)
    assert not motion_events.closures(gap).any()


def test_still_slow_and_spiked_channels_have_no_events():
    time = clock(60)
    still = np.full((len(time), 2), 0.3)
    still[:, 1] = 0.0
    slow = 0.5 + 0.4 * np.sin(2 * np.pi * 0.2 * time)
    assert not motion_events.excursions(still, 60).any()
    assert not motion_events.excursions(jittered(slow, 0, 0.01), 60).any()
    spiked = jittered(slow, 0, 0.01)
    spiked[200] += 0.1
    assert not motion_events.excursions(spiked, 60).any()


@pytest.mark.parametrize("rate", [60, 120])
def test_lips_that_meet_and_part_are_found(rate):
    time = clock(rate)
    shut = sum(blink(time - start) for start in BLINKS_S)
    gap = 2 + 20 * (1 - shut) + 0.2 * np.random.default_rng(0).standard_normal(len(time))
    gap[5:9] = np.nan
    found = np.flatnonzero(motion_events.closures(gap))
    frames = np.array(at_their_height(rate))
    assert np.abs(found[:, None] - frames).min(axis=1).max() <= 0.1 * rate
    assert np.abs(found[:, None] - frames).min(axis=0).max() <= 0.1 * rate
    assert not motion_events.closures(np.full(50, np.nan)).any()


def test_closures_of_the_points_are_kept_in_channels_of_the_lips():
    rate = 60
    time = clock(rate)
    shut = sum(blink(time - start) for start in BLINKS_S)
    smile, frames = 0.6 * (1 - shut), at_their_height(rate)
    rng = np.random.default_rng(3)
    values = np.stack([smile, smile, smile, smile], axis=1)
    values = values + 0.01 * rng.standard_normal(values.shape)
    made, events = kept(values, rate, NAMES, gap=20 * (1 - shut))
    plain, _ = kept(values, rate, ["a.b", "a.c", "a.d", "a.e"])
    assert events[frames][:, [1, 2]].min() == 1
    # no lips: their own events or none
    assert events[:, 3].max() == 0
    for channel in (1, 2):
        assert made[frames, channel].mean() < plain[frames, channel].mean() - 0.02
    np.testing.assert_array_equal(made[:, 3], plain[:, 3])


def test_without_points_the_jaw_tells_when_lips_close():
    rate = 120
    shut = sum(blink(clock(rate) - start) for start in BLINKS_S)
    still = np.full_like(shut, 0.2)
    values = np.stack([still, 0.6 * (1 - shut), still, still], axis=1)
    values = values + 0.005 * np.random.default_rng(3).standard_normal(values.shape)
    _, events = kept(values, rate, NAMES)
    frames = at_their_height(rate)
    np.testing.assert_array_equal(events[frames][:, [1, 2]], 1)
    np.testing.assert_array_equal(events[:, [0, 3]], 0)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        *[
            (name, "blink")
            for name in ("face.eyeBlinkLeft", "face.EYE_BLINK_r", "l.blink", "m.Eye Blink")
        ],
        *[
            (name, "closure")
            for name in ("face.jawOpen", "mouth.rom_f0001", "face.LipsUp", "x.MouthClose")
        ],
        *[(name, "") for name in ("face.browUp", "eyes.rom_f0003", "face.cheekPuff")],
    ],
)
def test_names_say_what_a_channel_keeps(name, kind):
    assert kept_moments.kinds([name], [""]) == [kind]
    assert kept_moments.kinds([name, name], ["blink", "closure"]) == ["blink", "closure"]


def test_a_channel_that_is_marked_is_kept_whatever_its_name():
    rate = 60
    noisy = jittered(blinking(rate), 2)
    for asked, found in (("blink", True), ("closure", True), ("", False)):
        events = kept_moments.find(noisy, ["a.key_12"], [asked], rate)
        assert (events[at_their_height(rate)] == 1).all() == found
        assert events.any() == found


@hypothesis.settings(max_examples=40)
@hypothesis.given(st.integers(0, 2**32 - 1), st.integers(1, 80), st.sampled_from([24, 60, 120]))
def test_nothing_is_delayed(seed, count, rate):
    rng = np.random.default_rng(seed)
    values = np.cumsum(rng.standard_normal((count, 4)), axis=0)
    values[:, 0] = np.abs(values[:, 0]) > 1
    forwards, events = kept(values, rate, NAMES)
    backwards, swapped = kept(values[::-1], rate, NAMES)
    np.testing.assert_allclose(events, swapped[::-1], atol=1e-12)
    np.testing.assert_allclose(forwards, backwards[::-1], atol=1e-9)
    mirrored = np.concatenate([values, values[-2::-1]])
    made, _ = kept(mirrored, rate, NAMES)
    np.testing.assert_allclose(made, made[::-1], atol=1e-9)


def test_an_infinite_frequency_leaves_a_channel_as_it_is():
    rng = np.random.default_rng(0)
    values, events = rng.standard_normal((90, 3)), np.zeros((90, 3))
    made = motion_filter.filtered(values, 60, np.array([np.inf, 10, np.inf]), events)
    np.testing.assert_array_equal(made[:, [0, 2]], values[:, [0, 2]])
    assert np.abs(made[:, 1] - values[:, 1]).max() > 0.1
    every = motion_filter.filtered(values, 60, np.full(3, np.inf), events)
    np.testing.assert_array_equal(every, values)


def test_a_lower_frequency_smooths_more():
    noise = np.random.default_rng(0).standard_normal((600, 4))
    cutoff = np.array([20.0, 10.0, 5.0, 1.0])
    made = motion_filter.filtered(noise, 60, cutoff, np.zeros(noise.shape))
    assert (np.diff(made.std(axis=0)) < -0.05).all()


def test_bad_arrays_are_refused():
    with pytest.raises(ValueError, match=r"cutoff \(2,\) and events \(5, 3\)"):
        motion_filter.filtered(np.zeros((5, 3)), 60, np.ones(2), np.zeros((5, 3)))
    with pytest.raises(ValueError, match=r"cutoff 0.0 is not above zero"):
        motion_filter.filtered(np.zeros((5, 1)), 60, np.zeros(1), np.zeros((5, 1)))


@hypothesis.settings(deadline=None, max_examples=30)
@hypothesis.given(
    st.integers(0, 10_000), st.sampled_from([30, 60, 120]), st.sampled_from([0.0, 0.05, 0.5])
)
def test_parts_of_a_whole_stay_parts_of_it(seed, rate, noise):
    rng = np.random.default_rng(seed)
    time = clock(rate, 4.0)
    closed = np.clip(sum(blink(time - start) for start in rng.uniform(0, 3.5, 4)), 0, 1)
    waves = 2 * np.sin(np.outer(time, rng.uniform(1, 40, 6)) + rng.uniform(0, 6, 6))
    rest = np.exp(waves + noise * rng.standard_normal(waves.shape))
    rest *= ((1 - closed) / rest.sum(axis=1))[:, None]
    # two wholes: all their parts but one, which moves nothing, have a column
    values = np.concatenate([closed[:, None], rest[:, :3], rest[:, 3:5]], axis=1)
    whole = np.array([7, 7, 7, 7, 2, 2])
    names = ["eyes.blink_closed", *(f"eyes.emotion_{i}" for i in range(3))]
    names += ["mouth.speech_m", "mouth.emotion_joy"]
    gap = 0.2 + 0.2 * np.sin(9 * time)
    events = kept_moments.find(values, names, [""] * 6, rate, gap)
    made = motion_filter.filtered(values, rate, np.full(6, 10.0), events, whole)
    assert made.min() > -1e-12
    for part in (whole == 7, whole == 2):
        assert made[:, part].sum(axis=1).max() <= values[:, part].sum(axis=1).max() + 1e-12


def test_what_goes_together_keeps_its_blinks_and_loses_its_jitter():
    rate = 120
    truth = blinking(rate)
    noise = 0.02 * np.random.default_rng(0).standard_normal((len(truth), 2))
    values = np.stack([truth, 1 - truth], axis=1) + noise
    names = ["eyes.blink_closed", "eyes.emotion_joy"]
    events = kept_moments.find(values, names, ["", ""], rate)
    made = motion_filter.filtered(values, rate, np.full(2, 10.0), events, np.zeros(2, int))
    peaks = at_their_height(rate)
    assert np.mean(made[peaks, 0]) > 0.95 * np.mean(truth[peaks])
    calm = events[:, 0] == 0
    wanted = np.stack([truth, 1 - truth], axis=1)[calm]
    assert np.std(made[calm] - wanted) < 0.5 * np.std(values[calm] - wanted)


def test_curves_apart_break_the_whole_that_curves_together_keep():
    rate = 60
    closed = blinking(rate, height=0.8)
    values = np.stack([closed, 1 - closed], axis=1)
    names = ["eyes.blink_closed", "eyes.emotion_joy"]
    events = kept_moments.find(values, names, ["", ""], rate)
    cutoff = np.full(2, 5.0)
    apart = motion_filter.filtered(values, rate, cutoff, events)
    together = motion_filter.filtered(values, rate, cutoff, events, np.zeros(2, int))
    assert apart.sum(axis=1).max() > 1.05
    np.testing.assert_allclose(together.sum(axis=1), 1.0, atol=1e-12)
