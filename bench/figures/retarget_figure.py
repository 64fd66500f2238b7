"""Figure 8 (a): frames of the talking take beside the characters that it drives."""

from collections import Counter
from pathlib import Path

import numpy as np

from bench.figures import example, look, portraits
from stages.files import exr, film, key_shapes, rig

SHOT = "talk"
WIDTH, TOP = 12.0, 0.25  # inches


def draw(show: Path, path: Path) -> None:
    """Draw the film's frames and, below, the baked frames of every character."""
    frames = portraits.varied_frames(show, SHOT)
    rows = [portraits.film_pictures(show, SHOT, frames)]
    rows += [_baked(show, name, frames) for name in portraits.CHARACTERS]
    shapes = key_shapes.read(example.of_actor(show, "key_shapes.parquet"))
    counts = Counter(shape.region for shape in shapes)
    words = ", ".join(f"{count} for the {region}" for region, count in counts.items())
    length = film.promised_count(example.film(show, SHOT))
    caption = (
        f"Figure 8 (a). Frames of the take '{SHOT}' ({length} frames) and what it makes of three "
        f"characters. The key shapes come from the range-of-motion take: {words}. Each region is "
        "solved and moved on its own; the head's motion in the plane moves the whole. The "
        "frames are chosen to differ."
    )
    height = len(rows) * WIDTH / len(frames) + TOP
    whole, drawn = look.page(WIDTH, height, caption)
    portraits.sheet(drawn, rows, ["film", *portraits.CHARACTERS], frames, 1.0)
    look.save(whole, path)


def _baked(show: Path, name: str, frames: list[int]) -> list[np.ndarray]:
    """Return pictures of a character's baked frames at the times of the film's frames."""
    description = exr.read_json(example.of_take(show, SHOT, name, "mesh.json"))
    baked = exr.Reader(example.of_take(show, SHOT, name, "mesh.exr"), description)
    character = rig.read(example.rig(show, name), "mesh")
    rate = film.nominal_rate(example.film(show, SHOT))
    rows = [baked.nearest(float(frame / rate)) for frame in frames]
    return portraits.character_pictures(character, np.stack([baked.frame(row) for row in rows]))
