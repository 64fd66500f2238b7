"""Figure 6 of Kholgade et al.: what the layers say under each mask, and what they show."""

from pathlib import Path

import numpy as np

from bench.figures import layer_pictures, layer_take, look, own_figure, portraits

WIDTH, TOP = 12.0, 0.25  # inches
TIMELINE, BELOW = 1.3, 0.55  # inches
ASPECT = 0.95
COUNTS = {"emotion": 3, "speech": 2, "blink": 1}  # of the frames shown
APART_S = 0.3
CLOSING = 0.5


def draw(show: Path, path: Path) -> None:
    """Draw frames of the take layer by layer, and the weights of every mask over time."""
    take = layer_take.read(show)
    frames, strongest = chosen_frames(take)
    points = layer_take.in_picture(show, take, frames)
    filmed, _ = layer_pictures.of_film(show, take, frames, points, ASPECT)
    rows = [filmed, *_characters(show, take, frames)]
    titles = [f"{frame}, {layer}" for frame, layer in zip(frames, strongest, strict=True)]
    pictures = len(rows) * WIDTH / len(frames) / ASPECT + TOP
    height = pictures + len(take.solved.masks) * TIMELINE + BELOW
    whole, drawn = look.page(WIDTH, height, _caption(take))
    names = ["film", *(f"{layer} layer" for layer in take.solved.layers), "all layers"]
    portraits.sheet(drawn, rows, names, titles, pictures / height)
    _timelines(drawn, take, frames, height)
    look.save(whole, path)


def chosen_frames(take: layer_take.LayerTake) -> tuple[list[int], list[str]]:
    """Return frames of the film at which a layer moves the character most, and that layer.

    Of each layer they differ much, and no two are near one another.
    """
    solved = take.solved
    whole = np.arange(0, len(solved.frame), 2)
    free = np.nan_to_num(solved.confidence)[whole] >= 0.5
    picked = []
    for layer, count in COUNTS.items():
        rows = whole[free]
        output = layer_take.outputs(take, solved.frame[rows], layer) - take.character.neutral
        for row in portraits.farthest(output.reshape(len(rows), -1), rows, count):
            picked.append((int(solved.frame[rows[row]]), layer))
            free &= np.abs(solved.time_s[whole] - solved.time_s[rows[row]]) >= APART_S
    frames, strongest = zip(*sorted(picked), strict=True)
    return list(frames), list(strongest)


def _characters(show, take, frames):
    """Return a row of pictures for each layer and one for all of them, from one camera."""
    moved = [layer_take.outputs(take, frames, layer) for layer in take.solved.layers]
    whole = layer_take.outputs(take, frames)
    moved.append(own_figure.with_head(show, layer_take.SHOT, take.character, whole, frames))
    pictures = layer_pictures.characters(take, np.concatenate(moved), ASPECT)
    count = len(frames)
    return [pictures[start : start + count] for start in range(0, len(pictures), count)]


def _timelines(drawn, take, frames, height):
    """Draw the weights of every mask as stacked areas, and where the lips count as closed."""
    solved = take.solved
    colours = [layer_take.COLOURS[layer] for layer in solved.layers]
    count = len(solved.masks)
    closed = solved.measures["lip_bias"] > CLOSING
    for row, mask in enumerate(solved.masks):
        bottom = (BELOW + (count - 1 - row) * TIMELINE) / height
        panel = drawn.add_axes((0.045, bottom, 0.94, (TIMELINE - 0.38) / height))
        panel.stackplot(
            solved.time_s, solved.weights[:, row].T, colors=colours, labels=solved.layers, lw=0
        )
        panel.set(xlim=(solved.time_s[0], solved.time_s[-1]), ylim=(0, 1), yticks=(0, 0.5, 1))
        panel.set_title(f"Weights under the mask '{mask}'", loc="left", pad=9, **look.TITLE)
        panel.spines[["top", "right"]].set_visible(False)
        panel.tick_params(labelbottom=row == count - 1)
        for frame in frames:
            panel.axvline(float(frame / solved.rate), color="white", lw=2.2)
            panel.axvline(float(frame / solved.rate), color=look.INK, lw=0.9)
        if mask == layer_take.LIP_MASK:
            strip = {"transform": panel.get_xaxis_transform(), "clip_on": False, "lw": 0}
            panel.fill_between(
                solved.time_s,
                1.025,
                1.085,
                where=closed,
                color=look.INK,
                label="lips closed",
                **strip,
            )
            handles, labels = panel.get_legend_handles_labels()
    drawn.axes[-count].legend(
        handles,
        labels,
        frameon=False,
        fontsize=9.5,
        ncols=4,
        loc="lower right",
        bbox_to_anchor=(1.0, 0.97),
        borderaxespad=0.0,
    )
    panel.set_xlabel("time [s] (lines: the frames above)")


def _caption(take):
    """Return the caption with the mean weights."""
    solved = take.solved
    means = np.nanmean(solved.weights, axis=0)
    found = "; ".join(
        f"{mask} " + ", ".join(f"{value:.2f}" for value in row)
        for mask, row in zip(solved.masks, means, strict=True)
    )
    return (
        f"Figure 6 of Kholgade et al. Frames of the take '{layer_take.SHOT}', counted at "
        f"{solved.rate} Hz, and what each layer with its weights makes of the "
        f"{layer_take.CHARACTER}, before smoothing and without the head's motion; the last row "
        "adds the layers and the head. Each frame is where the layer named above moves the "
        "character most, or most differently from that layer's other frames here. Below, the "
        "weights of every mask over the take, one in sum; a black strip where the lips' bias "
        f"towards speech m is over {CLOSING:g}. A layer that stands at its neutral under a mask "
        "moves nothing there: its weight only holds the others back. Mean weights of "
        f"{', '.join(solved.layers)}: {found}."
    )
