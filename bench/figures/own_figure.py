"""Figure 8 (b): a second sequence with key shapes of its own, and what that is worth."""

from pathlib import Path

import numpy as np

from bench.figures import example, look, own_key_shapes, portraits
from stages.core import head_transform
from stages.files import series

WIDTH, TOP, CURVES = 12.0, 0.25, 2.6  # inches
MEASURED = "human"
STYLES = {
    own_key_shapes.SHOWN: ("the show's key shapes", {"color": "#999999", "ls": ":"}),
    own_key_shapes.SAME: (
        "as many as its own, of the range-of-motion take",
        {"color": "#0072B2", "ls": "--"},
    ),
    own_key_shapes.OWN: ("the sequence's own", {"color": "#D55E00", "ls": "-"}),
}


def draw(show: Path, path: Path) -> None:
    """Drive every character by the sequence's own key shapes, and measure all three choices."""
    shot = own_key_shapes.SHOT
    sequence = own_key_shapes.read(show)
    solved = {name: own_key_shapes.solve(sequence, name) for name in sequence.chosen}
    frames = portraits.varied_frames(show, shot)
    rows, curves = [portraits.film_pictures(show, shot, frames)], {}
    for name in portraits.CHARACTERS:
        character = own_key_shapes.target(show, name, sequence.frame)
        chosen, weights = sequence.chosen[own_key_shapes.OWN], solved[own_key_shapes.OWN][0]
        at = np.searchsorted(sequence.frame, frames)
        shapes = own_key_shapes.play(character, chosen, weights, 0)[at]
        moved = with_head(show, shot, character.rig, shapes, frames)
        rows.append(portraits.character_pictures(character.rig, moved))
        curves[name] = {
            which: own_key_shapes.target_error(character, sequence.chosen[which], solution[0])
            for which, solution in solved.items()
        }
    pictures = len(rows) * WIDTH / len(frames) + TOP
    height = pictures + CURVES
    whole, drawn = look.page(WIDTH, height, _caption(sequence, solved, curves))
    portraits.sheet(drawn, rows, ["film", *portraits.CHARACTERS], frames, pictures / height)
    panel = drawn.add_axes((0.06, 0.5 / height, 0.925, (CURVES - 0.95) / height))
    _curves(panel, sequence.frame, curves[MEASURED], frames)
    look.save(whole, path)


def with_head(
    show: Path, shot: str, character, shapes: np.ndarray, frames: list[int]
) -> np.ndarray:
    """Move shapes (N, V, 3) of a character with the head of a shot's frames."""
    path = example.of_shot(show, shot, "head_motion.parquet")
    motion = series.read(path, "head_motion")
    rows = np.searchsorted(motion.frame, frames)
    turns, shifts, (scale,) = (
        np.stack([motion.columns[name][rows] for name in names])
        for names in (
            [f"rotation.{axis}" for axis in "xyzw"],
            [f"translation.{axis}" for axis in "xyz"],
            ["scale"],
        )
    )
    axes = head_transform.face_axes(character.up_axis)
    turns = head_transform.turned_quaternions(turns.T, axes)
    shifts = character.face_unit * shifts.T @ axes.T
    moved = [
        head_transform.apply(
            shape, head_transform.rotation_matrix(turn), shift, factor, character.pivot
        )
        for shape, turn, shift, factor in zip(shapes, turns, shifts, scale, strict=True)
    ]
    return np.stack(moved)


def _curves(panel, frame, errors, shown):
    """Draw the error in the target over time, with the frames shown above as ticks."""
    for which, (label, style) in STYLES.items():
        panel.plot(frame, 100 * errors[which], label=label, lw=1.6, **style)
    panel.set_xlim(frame[0], frame[-1])
    panel.set_ylim(0, 125 * max(values.max() for values in errors.values()))
    for number in shown:
        panel.axvline(number, color=look.FAINT, lw=1.2, zorder=0)
    panel.set_title(
        f"Distance of the {MEASURED} character's vertices from the truth [% of its face unit]",
        loc="left",
        **look.TITLE,
    )
    panel.set_xlabel("frame (grey lines: the frames above)")
    panel.legend(frameon=False, fontsize=9.5, ncols=3, loc="upper right")
    panel.spines[["top", "right"]].set_visible(False)


def _caption(sequence, solved, curves):
    """Return the caption with the numbers of every choice."""
    counts = own_key_shapes.COUNTS.items()
    words = ", ".join(f"{count} for the {region}" for region, count in counts)
    source = _by_choice(lambda which: _source(solved[which][1]))
    target = _by_choice(lambda which: _target(curves, which))
    length = len(sequence.frame)
    return (
        f"Figure 8 (b). A second sequence, the take '{own_key_shapes.SHOT}' ({length} frames), "
        f"with key shapes of its own: {words}, the pupils as a region of their own. They were "
        "chosen on its frames and sculpted from the truth, a tenth off like the example's. "
        "Root mean square errors in % of the face unit. In the source (mouth, eyes, pupils): "
        f"{source}. In the target ({', '.join(portraits.CHARACTERS)}; the vertices that "
        f"move, {own_key_shapes.DRAWS} sculptors): {target}."
    )


def _by_choice(numbers):
    """Return the numbers of every choice of key shapes as text."""
    return "; ".join(f"{label} {numbers(which)}" for which, (label, _) in STYLES.items())


def _source(error):
    """Return a choice's errors in the source as text."""
    return ", ".join(f"{100 * error[region]:.2f}" for region in own_key_shapes.COUNTS)


def _target(curves, which):
    """Return a choice's errors in the target as text."""
    found = (np.sqrt(np.mean(curves[name][which] ** 2)) for name in portraits.CHARACTERS)
    return ", ".join(f"{100 * value:.1f}" for value in found)
