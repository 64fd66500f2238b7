"""Frame rates as people write them: a whole number or a fraction such as 30000/1001."""

from fractions import Fraction

from stages.files import errors


def read(flag: str, text: str) -> Fraction | None:
    """Return a rate; None for an empty text.

    Raises
    ------
    errors.InputError
        if the text is no rate
    """
    if not text:
        return None
    try:
        rate = Fraction(text)
    except (ValueError, ZeroDivisionError):
        rate = Fraction(0)
    if not 0 < rate < 1000:
        raise errors.InputError(flag, f"'{text}' is no rate such as 30 or 30000/1001")
    return rate
