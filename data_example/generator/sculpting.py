"""Sculpt the characters' key shapes as an artist would, about a tenth off, and write them."""

import numpy as np

from data_example.generator import (
    cassette,
    clay_files,
    drawing,
    extreme_files,
    globe,
    human_mesh,
    params,
    puppet,
    radio,
    selection,
    shots,
    tortoise_files,
)

ERROR = 0.10
WAVES = 5
PUPPET_ROW = {"unit": "cm", "up_axis": "y", "pivot": "0 0 0", "face_unit": "6"}


def _lapse(points, rng):
    """Return a smooth relative error over points of RMS about ERROR, (V,)."""
    size = np.ptp(points, axis=0).max()
    waves = rng.normal(size=(WAVES, points.shape[1])) * 2.0 / size
    phases = rng.uniform(0, 2 * np.pi, WAVES)
    smooth = np.sqrt(2 / WAVES) * np.sin(points @ waves.T * np.pi + phases).sum(axis=1)
    return ERROR * (0.6 * rng.standard_normal() + 0.8 * smooth)


def sculpt(neutral, true, rng):
    """Return a true pose as an artist would have made it, (V, D).

    What moves is a little too far or not far enough, by an error that varies smoothly over the
    surface: neighbours err alike, and what should touch touches.
    """
    return neutral + (1 + _lapse(neutral, rng))[:, None] * (true - neutral)


def _obj(character, vertices, colours=None):
    """Return the text of an OBJ file."""
    lines = [f"# {character.name}"]
    places = [" ".join(_short(v, character.digits) for v in row) for row in vertices]
    if colours is not None:
        tones = [" ".join(_short(v, 3) for v in row) for row in colours]
        places = [f"{a} {b}" for a, b in zip(places, tones, strict=True)]
    lines += [f"v {place}" for place in places]
    lines += ["f " + " ".join(str(v + 1) for v in face) for face in character.faces]
    return "\n".join(lines) + "\n"


def _short(value, digits):
    """Return a number without idle zeros."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _csv(values):
    """Return the text of a table of controls."""
    rows = [f"{name},{_short(v, 4)}" for name, v in zip(puppet.NAMES, values, strict=True)]
    return "\n".join(["name,value", *rows]) + "\n"


def _write(path, text):
    """Write a file, making its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def write_all(folder, seed=41):
    """Write all characters under a folder and say what was written.

    Parameters
    ----------
    folder : pathlib.Path
        The folder of the characters.
    seed : int

    Returns
    -------
    rows : list of (character, file of its neutral, cells of its row of characters.tsv)
    """
    expression = shots.TAKES[selection.SHOT]().expression
    poses = [
        (region, frame, params.only(params.from_row(expression[frame]), region))
        for region, frames in selection.LOCKED.items()
        for frame in frames
    ]
    zero = params.neutral()
    rows = []
    for number, module in enumerate((human_mesh, radio, drawing)):
        character = module.build(zero)
        here = folder / character.name
        neutral = character.pose(zero)
        _write(here / "neutral.obj", _obj(character, neutral, character.colours))
        _write(here / "masks.tsv", "\n".join(character.masks) + "\n")
        for region, frame, p in poses:
            rng = np.random.default_rng([seed, number, frame])
            made = sculpt(neutral, character.pose(p), rng)
            name = f"{selection.SHOT}_f{frame:04d}.obj"
            _write(here / "sculpts" / region / name, _obj(character, made))
        rows.append((character.name, "neutral.obj", character.row))
    _write(folder / "puppet" / "neutral.csv", _csv(puppet.controls(zero)))
    _write(folder / "puppet" / "masks.tsv", "\n".join(puppet.masks()) + "\n")
    for region, frame, p in poses:
        rng = np.random.default_rng([seed, 9, frame])
        neutral, true = puppet.controls(zero), puppet.controls(p)
        made = neutral + (1 + ERROR * rng.standard_normal()) * (true - neutral)
        name = f"{selection.SHOT}_f{frame:04d}.csv"
        _write(folder / "puppet" / "sculpts" / region / name, _csv(made))
    rows.append(("puppet", "neutral.csv", PUPPET_ROW))
    clay_files.write_all(folder / "clay")
    for played in (globe.build(), cassette.build()):
        extreme_files.write(folder / played.name, played)
        rows.append((played.name, "neutral.ply", played.row))
    tortoise_files.write_all(folder / "tortoise")
    return rows
