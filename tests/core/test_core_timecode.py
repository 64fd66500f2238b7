from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import timecode

NTSC, NTSC60 = Fraction(30000, 1001), Fraction(60000, 1001)
RATES = [Fraction(24000, 1001), 24, 25, NTSC, 30, 50, NTSC60, 60, 120]


@pytest.mark.parametrize(
    ("text", "rate", "count"),
    [
        ("00:00:59;29", NTSC, 1799),
        ("00:01:00;02", NTSC, 1800),
        ("00:10:00;00", NTSC, 17982),
        ("01:00:00;00", NTSC, 107892),
        ("00:01:00;04", NTSC60, 3600),
        ("01:00:00:00", NTSC, 108000),
        ("10:00:00:12", Fraction(24), 864012),
        ("13:13:04:31", Fraction(60), 2855071),
    ],
)
def test_known_timecodes(text, rate, count):
    assert timecode.parse(text, rate) == count
    assert timecode.write(count, rate, ";" in text) == text


@pytest.mark.parametrize("rate", [NTSC, NTSC60])
def test_dropped_numbers_never_occur_and_all_others_do(rate):
    """Count as the standard says: leave numbers out one by one."""
    base, dropped = timecode.numbers_per_second(rate), timecode.DROPPED[rate]
    count = 0
    for minute in range(21):
        for number in range(60 * base):
            if minute % 10 and number < dropped:
                continue
            text = f"00:{minute:02d}:{number // base:02d};{number % base:02d}"
            assert timecode.write(count, rate, drops=True) == text
            assert timecode.parse(text, rate) == count
            count += 1


@given(st.sampled_from(RATES), st.integers(0, 86399), st.booleans())
def test_a_timecode_comes_back(rate, second, drops):
    rate = Fraction(rate)
    if drops and rate not in timecode.DROPPED:
        return
    count = int(second * rate)
    assert timecode.parse(timecode.write(count, rate, drops), rate) == count


@pytest.mark.parametrize(
    ("text", "rate", "message"),
    [
        ("1:2:3", Fraction(25), "no timecode"),
        ("00:00:00:25", Fraction(25), "beyond 23:59:59:24"),
        ("00:01:00;01", NTSC, "leaves out"),
        ("00:01:00;05", Fraction(25), "not at 25"),
    ],
)
def test_what_is_no_timecode_is_refused(text, rate, message):
    with pytest.raises(ValueError, match=message):
        timecode.parse(text, rate)
