"""Figures 4 and 5: lip contours rebuilt from key shapes, in the source and in a traced target."""

from typing import NamedTuple

import numpy as np

from bench.figures import lip_trial, look

SPREAD = 5
# inches
WIDTH = 12.0
TITLE = 0.36
WORDS = 0.3
COLOURS = {
    lip_trial.PLAIN: "#D55E00",
    lip_trial.NONNEGATIVE: "#0072B2",
    lip_trial.DEFAULT: "#009E73",
}
TRACED = "#7A4FA3"


class Cell(NamedTuple):
    """Say what one panel shows.

    Attributes
    ----------
    behind : (P, 2) float array [face units], filled
    drawn : (P, 2) float array [face units], as lines
    colour : of the lines
    words : below it
    strong : whether the words stand out
    """

    behind: np.ndarray
    drawn: np.ndarray
    colour: str
    words: str
    strong: bool = False


def draw_least_squares(trial, borrowed, path):
    """Draw figure 4: plain least squares on absolute shapes.

    Parameters
    ----------
    trial, borrowed : lip_trial.Trial
        With key shapes of the take itself, and of the range-of-motion take.
    path : pathlib.Path
    """
    name = lip_trial.PLAIN
    frames = lip_trial.sample(trial, name, SPREAD)
    own, other = trial.solved[name], borrowed.solved[name]
    caption = (
        f"Figure 4. Lip contours rebuilt by plain least squares on absolute shapes (equation 3), "
        f"{lip_trial.COUNT} key shapes by maximum spread. Grey: the tracked lips; lines: the "
        f"reconstruction. {_traced_words()} Root mean square distance of a point over all "
        f"{len(trial.frames)} frames: {_percent(own.source_error)} of the face unit in the source, "
        f"{100 * own.target_rms:.2f} % in the target (mean of {lip_trial.DRAWS} tracings); worst "
        f"frame {100 * own.target_error.max():.1f} %; largest weight {own.largest:.1f}. With the "
        f"{lip_trial.COUNT} key shapes of the range-of-motion take: {_percent(other.source_error)} "
        f"and {100 * other.target_rms:.2f} %, largest weight {other.largest:.1f}."
    )
    rows = [
        ("Key shapes, tracked (grey) and traced by hand (lines)", _traced(trial, len(frames))),
        ("(a)  Source domain: the tracked key shapes", _played(trial, name, frames, "source")),
        ("(b)  Target domain: the traced key shapes", _played(trial, name, frames, "target")),
    ]
    _draw(rows, trial.contours, caption, path)


def draw_nonnegative(trial, borrowed, solve, path):
    """Draw figure 5: non-negative weights, and the show's own solve.

    Parameters
    ----------
    trial, borrowed : lip_trial.Trial
        As in `draw_least_squares`.
    solve : str
        Name of the show's own solve.
    path : pathlib.Path
    """
    frames = lip_trial.sample(trial, lip_trial.PLAIN, SPREAD)
    rows = []
    titles = {
        lip_trial.NONNEGATIVE: "Non-negative weights (equation 4)",
        lip_trial.DEFAULT: f"Weights by {solve} (the default here)",
    }
    for (name, words), letters in zip(titles.items(), ("ab", "cd"), strict=True):
        own = [*frames, int(trial.solved[name].target_error.argmax())]
        for letter, domain in zip(letters, ("source", "target"), strict=True):
            title = f"({letter})  {words}, {domain} domain"
            rows.append((title, _played(trial, name, own, domain)))
    numbers = ". ".join(_numbers(name, words, trial, borrowed) for name, words in titles.items())
    plain = trial.solved[lip_trial.PLAIN]
    caption = (
        f"Figure 5. The frames of figure 4, and each solve's own worst frame, rebuilt by weights "
        f"kept from cancelling each other. {_traced_words()} {numbers}. Least squares (figure 4): "
        f"{_percent(plain.source_error)} and {100 * plain.target_rms:.2f} %. The tracing alone is "
        f"{100 * lip_trial.TRACING:.1f} %."
    )
    _draw(rows, trial.contours, caption, path)


def _traced_words():
    """Return the sentence on the traced key shapes."""
    return (
        "The target's key shapes and neutral are traced: a smooth error of "
        f"{100 * lip_trial.TRACING:.1f} % of the face unit (the distance of the eyes) along each "
        "contour, from a seed."
    )


def _numbers(name, words, trial, borrowed):
    """Return a solve's sentence of numbers."""
    own, other = trial.solved[name], borrowed.solved[name]
    return (
        f"{words}: source {_percent(own.source_error)}, target "
        f"{100 * own.target_rms:.2f} %, worst frame {100 * own.target_error.max():.1f} %, largest "
        f"weight {own.largest:.1f} (key shapes of the range-of-motion take: "
        f"{_percent(other.source_error)}, {100 * other.target_rms:.2f} %)"
    )


def _percent(errors):
    """Return the root mean square of errors as text."""
    return f"{100 * lip_trial.rms(errors):.2f} %"


def _traced(trial, count):
    """Return cells of some key shapes as tracked and as traced."""
    shown = np.linspace(0, len(trial.shapes) - 1, count).astype(int)
    return [Cell(trial.shapes[i], trial.traced[i], TRACED, f"key shape {i + 1}") for i in shown]


def _played(trial, name, frames, domain):
    """Return cells of a solve's frames in one domain."""
    solved = trial.solved[name]
    points, errors = getattr(solved, domain), getattr(solved, f"{domain}_error")
    worst = int(solved.target_error.argmax())
    cells = []
    for i in frames:
        strong = i == worst and domain == "target"
        place = f"worst ({trial.numbers[i]})" if strong else f"frame {trial.numbers[i]}"
        words = f"{place}: {100 * errors[i]:.2f} %"
        cells.append(Cell(trial.frames[i], points[i], COLOURS[name], words, strong))
    return cells


def _draw(rows, contours, caption, path):
    """Draw rows of cells with their titles."""
    columns = len(rows[0][1])
    every = [cell for _, cells in rows for cell in cells]
    points = np.concatenate([shape for cell in every for shape in (cell.behind, cell.drawn)])
    low, high = points.min(axis=0), points.max(axis=0)
    wide, tall = 1.06 * (high - low)
    panel_height = WIDTH / columns * tall / wide
    row_height = TITLE + panel_height + WORDS
    height = len(rows) * row_height
    whole, drawn = look.page(WIDTH, height, caption)
    for row, (title, cells) in enumerate(rows):
        top = height - row * row_height
        drawn.text(0.14 / WIDTH, (top - 0.1) / height, title, va="top", **look.TITLE)
        bottom = (top - TITLE - panel_height) / height
        for column, cell in enumerate(cells):
            place = (column / columns, bottom, 1 / columns, panel_height / height)
            panel = drawn.add_axes(place)
            panel.set(xlim=_around(low[0], high[0]), ylim=_around(low[1], high[1]))
            panel.set_axis_off()
            _lips(panel, cell, contours)
            drawn.text(
                (column + 0.5) / columns,
                bottom - 0.03 / height,
                cell.words,
                va="top",
                ha="center",
                size=9,
                color=look.INK,
                weight="bold" if cell.strong else "normal",
            )
    look.save(whole, path)


def _around(low, high):
    """Return limits a little wider than an interval."""
    return low - 0.03 * (high - low), high + 0.03 * (high - low)


def _lips(panel, cell, contours):
    """Draw the lips behind, filled, and the drawn contours with their control points."""
    outer, *inner = (contours == name for name in dict.fromkeys(contours))
    panel.fill(*cell.behind[outer].T, color=look.FAINT, lw=0)
    for chosen in inner:
        panel.fill(*cell.behind[chosen].T, color="white", lw=0)
    for chosen in (outer, *inner):
        closed = np.vstack([cell.drawn[chosen], cell.drawn[chosen][:1]])
        panel.plot(*closed.T, color=cell.colour, lw=1.2, marker="o", ms=1.8, mew=0)
