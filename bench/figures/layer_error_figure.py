"""Figure 8 of Kholgade et al.: reconstruction errors of the layers together and of each alone."""

from pathlib import Path

import numpy as np

from bench.figures import layer_errors, layer_take, look

WIDTH = 12.0  # inches
MAIN, SECOND, SMALL, TITLE, BELOW = 3.0, 1.6, 1.7, 0.4, 0.45  # inches
LEFT, RIGHT, GAP = 0.6, 0.15, 0.5  # inches
OTHERS = ("faces", "capture")
PUBLISHED = (layer_errors.LAYERED, "emotion", "speech", "blink")
STYLES = {
    layer_errors.LAYERED: {"color": look.INK, "lw": 2.0, "zorder": 4},
    layer_errors.DELIVERED: {"color": look.INK, "lw": 1.2, "ls": (0, (2, 1.2)), "zorder": 3},
    **{name: {"color": colour, "lw": 1.3} for name, colour in layer_take.COLOURS.items()},
}


def draw(show: Path, path: Path) -> None:
    """Draw the errors of the take, and of the same layers on other shots and points."""
    shot = layer_take.SHOT
    main = layer_errors.of_shot(show, shot)
    small = {f"'{shot}', markers alone": layer_errors.of_shot(show, shot, ["markers"])}
    small |= {f"'{other}'": layer_errors.of_shot(show, other) for other in OTHERS}
    height = MAIN + SECOND + SMALL + 3 * (TITLE + BELOW)
    whole, drawn = look.page(WIDTH, height, _caption(main, small))
    row = WIDTH - LEFT - RIGHT
    top = height - TITLE
    panel = _panel(drawn, height, (LEFT, top - MAIN, row, MAIN))
    _curves(panel, main.time_s, main.of_kind["markers"], f"Error of the markers in '{shot}' [mm]")
    panel.legend(frameon=False, fontsize=9.5, ncols=5, loc="upper right", borderaxespad=0.1)
    top -= MAIN + BELOW + TITLE
    panel = _panel(drawn, height, (LEFT, top - SECOND, row, SECOND))
    percent = {way: 100 * error for way, error in main.of_kind["video"].items()}
    title = f"Error of the film's points in '{shot}' [% of the face unit]"
    _curves(panel, main.time_s, percent, title)
    panel.legend(frameon=False, fontsize=9.5, ncols=5, loc="upper right", borderaxespad=0.1)
    panel.set_xlabel("time [s]")
    top -= SECOND + BELOW + TITLE
    wide = (row - GAP * (len(small) - 1)) / len(small)
    for column, (name, errors) in enumerate(small.items()):
        place = (LEFT + column * (wide + GAP), top - SMALL, wide, SMALL)
        panel = _panel(drawn, height, place)
        _curves(panel, errors.time_s, errors.of_kind["markers"], f"{name} [mm]")
        panel.set_xlabel("time [s]")
    look.save(whole, path)


def order(errors: dict[str, np.ndarray]) -> list[str]:
    """Return the published ways in the order of their mean errors."""
    return sorted(PUBLISHED, key=lambda way: np.nanmean(errors[way]))


def _panel(drawn, height, place):
    """Return axes at a place in inches from the lower left."""
    left, bottom, wide, tall = place
    return drawn.add_axes((left / WIDTH, bottom / height, wide / WIDTH, tall / height))


def _curves(panel, time_s, errors, title):
    """Draw an error of every way over time."""
    for way in (way for way in STYLES if way in errors):
        label = f"{way}, mean {np.nanmean(errors[way]):.2f}"
        panel.plot(time_s, errors[way], label=label, **STYLES[way])
    top = max(np.nanmax(error) for error in errors.values())
    panel.set(xlim=(time_s[0], time_s[-1]), ylim=(0, 1.18 * top))
    panel.set_title(title, loc="left", **look.TITLE)
    panel.spines[["top", "right"]].set_visible(False)
    panel.grid(axis="y", color=look.FAINT, lw=0.6)


def _caption(main, small):
    """Return the caption with the means and their order."""
    errors = main.of_kind["markers"]
    singles = np.min([errors[name] for name in layer_take.COLOURS], axis=0)
    lowest = 100 * np.mean(errors[layer_errors.LAYERED] <= singles)
    masks = "; ".join(f"{mask} {_means(found)}" for mask, found in main.under.items())
    others = "; ".join(
        f"{name} {_means(found.of_kind['markers'])}, {_order(found.of_kind['markers'])}"
        for name, found in small.items()
    )
    return (
        "Figure 8 of Kholgade et al. Root mean square distance of the actor's points on each "
        "frame from what is rebuilt: by all layers under all masks (line; no bias, nothing that "
        "holds to the last frame), by these as delivered, with both biases (dashes), and by one "
        "layer alone, the nearest point of its simplex by the same data term. Published order of "
        f"the means: {' < '.join(PUBLISHED)}; here {_order(errors)} by the markers and "
        f"{_order(main.of_kind['video'])} by the film's points. By the markers the layered "
        f"error is the lowest on {lowest:.0f} % of the frames. Means of "
        f"{', '.join(PUBLISHED)} in mm by mask: {masks}. "
        "Lower row: the same where the data term sees the markers alone, on the shot that the "
        f"extremes were picked from, and on one of markers without film: {others}."
    )


def _means(errors):
    """Return the means of the published ways as text."""
    return ", ".join(f"{np.nanmean(errors[way]):.2f}" for way in PUBLISHED)


def _order(errors):
    """Return the order of the means as text."""
    return " < ".join(order(errors))
