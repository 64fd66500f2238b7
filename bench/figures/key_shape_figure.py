"""Figure 6: the error of rebuilt lips against the number of key shapes, for every selector."""

from pathlib import Path

import numpy as np

from bench.figures import example, look, region_frames
from stages.core import key_shape_errors, key_weights
from stages.files import key_shapes

SHOT, REGION = "rom", "mouth"
ERRORS = "key_shape_errors.parquet"
COUNTS = tuple(range(2, 25, 2))
FOLDS = 4
MOST_FRAMES = 240
QUOTED = 12
SPLITS = {"training": "training frames", "held_out": "held-out frames"}
PUBLISHED = ("maximum_spread", "clustering_2d", "clustering_3d", "convex_hull")
# the paper's own colours first; the others can be told apart without colour
STYLES = {
    "maximum_spread": ("maximum spread", {"color": "blue", "ls": "-"}),
    "clustering_2d": ("clustering, 2-D", {"color": "green", "ls": "--"}),
    "clustering_3d": ("clustering, 3-D", {"color": "magenta", "ls": "--"}),
    "clustering_2d_centres": ("centres of mass, 2-D", {"color": "green", "ls": ":"}),
    "clustering_3d_centres": ("centres of mass, 3-D", {"color": "magenta", "ls": ":"}),
    "convex_hull": ("convex hull, 2-D", {"color": "red", "ls": "", "marker": "o", "ms": 8}),
    "successive_projection": (
        "successive projection",
        {"color": "#E69F00", "ls": "-", "marker": "s", "ms": 4.5},
    ),
    "farthest_residual": (
        "farthest residual",
        {"color": "#777777", "ls": "-", "marker": "^", "ms": 5},
    ),
    "shared_residual": (
        "shared residual",
        {"color": "#CC79A7", "ls": "-", "marker": "P", "ms": 5.5},
    ),
    "swap_refinement": (
        "swap refinement",
        {"color": "#56B4E9", "ls": "-.", "marker": "v", "ms": 5},
    ),
    "expected_error": (
        "expected error",
        {"color": "black", "ls": "-", "marker": "D", "ms": 4.5},
    ),
}


def draw(show: Path, path: Path) -> None:
    """Draw the figure from the show's expressions and its own table of errors."""
    measured = key_shapes.read_errors(example.of_actor(show, ERRORS))
    own = [row for row in measured if row["region"] == REGION]
    settings = region_frames.settings(show, REGION)
    published = nonnegative_errors(region_frames.read(show, SHOT, REGION), settings.sigma)
    rows = (
        ("Non-negative weights (equation 4)", published),
        (f"Default weights ({settings.solve})", own),
    )
    whole, drawn = look.page(12.0, 9.6, _caption(published, own, settings))
    panels = drawn.subplots(2, 2, sharex=True, sharey="row")
    drawn.subplots_adjust(left=0.065, right=0.985, top=0.955, bottom=0.06, wspace=0.05, hspace=0.2)
    letters = iter("abcd")
    for (title, table), line in zip(rows, panels, strict=True):
        for (split, words), panel in zip(SPLITS.items(), line, strict=True):
            _panel(panel, [row for row in table if row["split"] == split], settings.method)
            panel.set_title(f"({next(letters)})  {title}, {words}", loc="left", **look.TITLE)
        shown = (row["rms"] for row in table if row["method"] in PUBLISHED)
        line[0].set_ylim(0, 105 * max(shown))
        line[0].set_ylabel("RMS distance of a lip point [% of the face unit]")
    for panel in panels[-1]:
        panel.set_xlabel("number of key shapes")
    panels[1, 1].legend(frameon=False, fontsize=10)
    look.save(whole, path)


def nonnegative_errors(lips: region_frames.RegionFrames, sigma: float) -> list[dict]:
    """Measure every selector with the weights of equation 4, on blocks of time.

    Parameters
    ----------
    lips : region_frames.RegionFrames
    sigma : float
        Of the selectors that expect an error of the sculpts.

    Returns
    -------
    list of dict
        method, count, split and rms [face units], as in `key_shape_errors.parquet`.

    Notes
    -----
    CB02 equations 4 and 5, figure 6; absolute shapes, no neutral.
    """
    step = max(1, len(lips.frame) // MOST_FRAMES)
    frames, neutral = region_frames.features(lips)
    frames = frames[::step]
    fold = key_shape_errors.blocks(np.repeat(SHOT, len(frames)), lips.frame[::step], FOLDS)
    seen = region_frames.candidates(frames, neutral, sigma)
    return [
        {"method": method, "count": count, "split": split, "rms": rms}
        for method in STYLES
        for count, split, rms in key_shape_errors.curve(seen, fold, method, COUNTS, _solve)
    ]


def _solve(frames, shapes, neutral):
    """Solve equation 4; the residual is that of ``sum_i w_i s_i``."""
    return key_weights.solve(frames, shapes, np.zeros_like(neutral), "nonnegative_absolute")


def _panel(panel, rows, default):
    """Draw the curves of one split; a method without rows has no curve."""
    for method, (label, style) in STYLES.items():
        own = sorted((row["count"], 100 * row["rms"]) for row in rows if row["method"] == method)
        words = f"{label} (default)" if method == default else label
        if own:
            panel.plot(*np.transpose(own), label=words, lw=1.8, **style)
    panel.set_xticks(range(2, 25, 2))
    panel.grid(color="#E8E8E8", lw=0.8)
    panel.set_axisbelow(True)
    panel.spines[["top", "right"]].set_visible(False)


def _caption(published, own, settings):
    """Return the caption with the numbers at `QUOTED` key shapes."""
    return (
        "Figure 6. Error of the lips' control points against the number of key shapes, for the "
        "paper's three selectors and the better ones here, of which "
        f"{STYLES[settings.method][0]} is the default. Training: the frames that key shapes were "
        f"chosen from; held out: blocks of time that were not seen ({FOLDS} folds of the "
        "range-of-motion take). The convex hull fixes its own number; a cluster's key shape is "
        "the frame nearest to its centre of mass. What lies above the panels is not shown. "
        "Swap refinement and expected error choose for weights of either sign, not for equation 4. "
        f"At {QUOTED} key shapes, held out: {_at(published, QUOTED)} with equation 4; "
        f"{_at(own, QUOTED)} with {settings.solve}."
    )


def _at(rows, count):
    """Return the held-out errors at a count as text."""
    found = {
        row["method"]: 100 * row["rms"]
        for row in rows
        if row["count"] == count and row["split"] == "held_out"
    }
    return ", ".join(f"{STYLES[name][0]} {found[name]:.2f} %" for name in STYLES if name in found)
