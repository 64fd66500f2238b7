"""Tempos as people write them: a number such as 1.25, or a fraction such as 24/25."""

from fractions import Fraction

from stages.files import errors

# beyond these no one would know the performance again; finer steps no one would hear
SLOWEST, FASTEST = Fraction(1, 4), Fraction(4)
FINEST = 10_000


def read(flag: str, text: str) -> Fraction:
    """Return how many seconds of a performance pass in one second of its take.

    Raises
    ------
    errors.InputError
        if the text is no tempo
    """
    try:
        # a power of ten can be a number that takes minutes to write out
        tempo = Fraction(text.strip() if "e" not in text.lower() else 0)
    except (ValueError, ZeroDivisionError):
        tempo = Fraction(0)
    if not SLOWEST <= tempo <= FASTEST or tempo.denominator > FINEST:
        message = f"'{text}' is no tempo from {SLOWEST} to {FASTEST} such as 1.25 or 24/25"
        raise errors.InputError(flag, message)
    return tempo
