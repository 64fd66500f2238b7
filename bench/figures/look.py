"""How the figures look: sizes, colours, captions, and files with the same bytes every time."""

import textwrap
from pathlib import Path

from matplotlib import figure
from matplotlib.backends import backend_agg

DPI = 160
INK = "#222222"
FAINT = "#D9D5D0"
TITLE = {"size": 11, "weight": "bold", "color": INK}
CAPTION_SIZE = 9.5
LINE_HEIGHT = 0.185  # inches
LETTERS_AN_INCH = 14.6


def page(width: float, height: float, caption: str):
    """Start a picture with its caption below.

    Parameters
    ----------
    width, height : of what is drawn [inches]; the caption comes below
    caption : wrapped to the width

    Returns
    -------
    whole, drawn : figure.Figure, figure.SubFigure
        The picture, and the part of it above the caption.
    """
    margin = 0.25
    # a number keeps its unit
    lines = textwrap.wrap(
        caption.replace(" %", "\u00a0%"), int((width - 2 * margin) * LETTERS_AN_INCH)
    )
    below = LINE_HEIGHT * len(lines) + 2 * margin
    whole = figure.Figure(figsize=(width, height + below), dpi=DPI, facecolor="white")
    backend_agg.FigureCanvasAgg(whole)
    drawn, text = whole.subfigures(2, 1, height_ratios=[height, below])
    text.text(
        margin / width,
        1 - margin / below / 2,
        "\n".join(lines),
        va="top",
        ha="left",
        size=CAPTION_SIZE,
        color=INK,
        linespacing=1.35,
    )
    return whole, drawn


def save(whole: figure.Figure, path: Path) -> None:
    """Write a picture as PNG without a word about the program."""
    path.parent.mkdir(parents=True, exist_ok=True)
    whole.savefig(path, dpi=DPI, metadata={"Software": None})
