import itertools

import numpy as np
import pytest

from data_example.generator import spoken
from stages.core import forced_alignment, word_agreement

STARTS = {"neutral": 0.4, "happiness": 2.6, "anger": 4.8, "sadness": 7.0}
LENGTH_S = 9.2
# Festival's phones that the dictionary writes otherwise
SAME = {"ax": "ah"}


@pytest.fixture(scope="module")
def voice():
    """The example's voice, 9 s, and its phones as spoken.Phone, silences left out."""
    phones = [
        phone
        for name, start in STARTS.items()
        for phone in spoken.moved(spoken.phones()[name], start)
        if phone.word
    ]
    return spoken.voice(STARTS, LENGTH_S).astype(np.float32), phones


@pytest.fixture(scope="module")
def aligned(voice):
    return forced_alignment.align(voice[0], words_of(voice[1]))


def words_of(phones):
    return [word.lower() for word, _ in itertools.groupby(phone.word for phone in phones)]


def test_phones_are_where_they_are_spoken(voice, aligned):
    found = [segment for segment in aligned if segment.word]
    assert {segment.phone for segment in aligned if not segment.word} == {"pau"}
    true = voice[1]
    starts = {}
    for (word, own), (_, known) in zip(
        itertools.groupby(found, lambda s: s.word),
        itertools.groupby(true, lambda p: p.word.lower()),
        strict=True,
    ):
        pairs = list(itertools.zip_longest(own, known))
        if all(o and k and o.phone == SAME.get(k.name, k.name) for o, k in pairs):
            starts |= {(word, k.start): o.start_s for o, k in pairs}
    assert len(starts) > 0.75 * len(true)
    wrong = np.abs([found - start for (_, start), found in starts.items()])
    assert np.mean(wrong) < 0.020
    assert np.median(wrong) < 0.012


def test_segments_tile_the_sound_and_scores_are_those_of_right_words(aligned):
    assert aligned[0].start_s == 0
    assert aligned[-1].end_s == pytest.approx(LENGTH_S)
    for one, other in itertools.pairwise(aligned):
        assert one.end_s == pytest.approx(other.start_s)
        assert one.start_s < one.end_s
        assert (one.phone, other.phone) != ("pau", "pau")
    assert word_agreement.agreement(aligned) > word_agreement.DOUBTFUL
    assert word_agreement.worst_passage(aligned).agreement > word_agreement.DOUBTFUL


def test_a_long_sound_is_cut_and_aligned_alike(voice, aligned):
    samples, phones = voice
    twice = forced_alignment.align(np.concatenate([samples] * 2), words_of(phones) * 2)
    found = [segment for segment in twice if segment.word]
    once = [segment for segment in aligned if segment.word]
    assert [s.phone for s in found] == [s.phone for s in once] * 2
    expected = [s.start_s + shift for shift in (0, LENGTH_S) for s in once]
    apart = np.abs([s.start_s for s in found] - np.array(expected))
    assert np.quantile(apart, 0.9) < 0.011
    assert twice[-1].end_s == pytest.approx(2 * LENGTH_S)
    assert len({round(s.end_s, 6) for s in twice}) == len(twice)


def test_level_does_not_matter_and_nothing_is_random(voice, aligned):
    samples, phones = voice
    quiet = forced_alignment.align(np.float32(0.25) * samples, words_of(phones))
    assert quiet == aligned


def test_other_words_fit_badly_or_nowhere(voice):
    samples, phones = voice
    words = words_of(phones)
    with pytest.raises(forced_alignment.NotAlignedError, match="find no place in the sound"):
        forced_alignment.align(samples[: 3 * forced_alignment.RATE], words)
    third = [word for word in words if word in words_of([p for p in phones if p.start > 7])]
    start = round(2.4 * forced_alignment.RATE)
    piece = samples[start : start + 2 * forced_alignment.RATE]
    wrong = forced_alignment.align(piece, third[:4])
    assert word_agreement.agreement(wrong) < word_agreement.OTHER_WORDS


def test_known_words_keep_their_times(voice):
    samples, phones = voice
    spans = [
        (own[0].start, own[-1].end, word.lower())
        for word, own in ((w, list(g)) for w, g in itertools.groupby(phones, lambda p: p.word))
    ]
    found = forced_alignment.align_spans(samples, spans)
    words = [list(g) for w, g in itertools.groupby(found, lambda s: s.word) if w]
    assert [(o[0].start_s, o[-1].end_s, o[0].word) for o in words] == spans
    for one, other in itertools.pairwise(found):
        assert one.end_s == pytest.approx(other.start_s)
    assert (found[0].start_s, found[-1].end_s) == (0, pytest.approx(LENGTH_S))


def test_a_word_too_short_for_its_phones_is_divided(voice):
    found = forced_alignment.align_spans(voice[0], [(1.0, 1.04, "at")])
    assert [(s.phone, s.word) for s in found] == [
        ("pau", ""), ("ae", "at"), ("t", "at"), ("pau", ""),
    ]  # fmt: skip
    assert [s.start_s for s in found] == pytest.approx([0, 1.0, 1.02, 1.04])
    assert np.isnan(word_agreement.agreement(found))
    with pytest.raises(ValueError, match="none of 4 phones has a word and a score"):
        word_agreement.worst_passage(found)


def test_the_worst_passage_is_the_one_that_fits_least():
    segments = [
        forced_alignment.Segment(at, at + 1.0, "b", f"w{at}", -1.0 - 3.0 * (at in (4, 5)))
        for at in range(9)
    ]
    segments.insert(3, forced_alignment.Segment(2.5, 3.0, "pau", "", -99.0))
    worst = word_agreement.worst_passage(segments, 2)
    assert worst == (["w4", "w5"], 4, -4.0)
    assert word_agreement.worst_passage(segments, 20).agreement == pytest.approx(-15 / 9)


def test_silence_and_unknown_words_are_named():
    with pytest.raises(ValueError, match="the sound is silent"):
        forced_alignment.align(np.zeros(16000, np.float32), ["boy"])
    words = ["boy", "xyzzy", "don't", "7", "xyzzy"]
    assert forced_alignment.unknown_words(words) == ["xyzzy", "7"]
