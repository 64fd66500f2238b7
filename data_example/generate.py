"""Make the example show again from its seeds: films, labels, truth, characters, marker takes.

Run `python -m data_example.generate` in the project's folder; `--only` makes one piece.
"""

import argparse
import pathlib

import numpy as np
from scipy.spatial import transform

from data_example.generator import (
    actor,
    capture,
    contours,
    film,
    labels,
    landmarks,
    params,
    play_files,
    render,
    sculpting,
    shots,
    sound,
    texture,
    truth,
)

PIECES = ("films", "labels", "characters", "capture", "play")


def _render(take, seed, hidden):
    """Yield the 8-bit pictures of a take; append to a list what is visible in each."""
    ada = actor.build()
    atlas = texture.paint(ada)
    empty = render.backdrop()
    neutral_brows = landmarks.brows()
    turns = transform.Rotation.from_quat(take.quaternion).as_matrix()
    for frame, row in enumerate(take.expression):
        p = params.from_row(row)
        still = actor.pose(ada, p)
        ambient = actor.shade(ada, still, p)
        vertices = actor.move(ada, still, turns[frame], take.translation[frame])
        light = float(take.light[frame])
        picture, depth = render.picture(
            ada,
            atlas,
            vertices,
            ambient,
            empty * np.float32(0.5 + 0.5 * light),
            light,
            0.4 * (light - 1),
        )
        dense = landmarks.in_space(p, neutral_brows)
        world = landmarks.moved(dense, turns[frame], take.translation[frame])
        hidden.append(~landmarks.visible(world, depth))
        yield film.noisy(picture, seed, frame)


def make_films(folder, names):
    """Render the named takes with their sound and keep their truth beside them."""
    for seed, name in enumerate(shots.TAKES):
        if name not in names:
            continue
        take = shots.TAKES[name]()
        duration = len(take.expression) / shots.RATE
        noise = sound.room(duration, seed + 50)
        samples = noise + sound.voice(take.phones, duration) if take.phones else noise
        known, hidden = truth.of_take(take, landmarks.brows()), []
        film.write(folder / "films" / f"{name}.mp4", _render(take, seed, hidden), samples)
        known["occluded"] = np.stack(hidden)
        truth.save(folder / "truth" / f"{name}.npz", known)


def make_labels(folder):
    """Write the labels of every take and the point set."""
    for name, frames in labels.FRAMES.items():
        text = labels.of_take(shots.TAKES[name](), frames, landmarks.brows())
        (folder / "labels" / f"{name}.csv").write_text(text, encoding="utf-8")
    lines = ["contour\tkind\tcount"]
    lines += [f"{name}\t{kind}\t{count}" for name, (kind, count, _) in contours.POINT_SET.items()]
    (folder / "point_set.tsv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def main(argv=None):
    """Make the pieces that were asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", choices=PIECES, help="make this piece alone")
    parser.add_argument("--shots", nargs="+", default=list(shots.TAKES), help="takes to render")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path(__file__).parent)
    arguments = parser.parse_args(argv)
    for name in ("films", "labels", "truth", "characters"):
        (arguments.folder / name).mkdir(parents=True, exist_ok=True)
    if arguments.only in (None, "labels"):
        make_labels(arguments.folder)
    if arguments.only in (None, "characters"):
        sculpting.write_all(arguments.folder / "characters")
    if arguments.only in (None, "capture"):
        capture.write_all(arguments.folder)
    if arguments.only in (None, "play"):
        play_files.write_all(arguments.folder)
    if arguments.only in (None, "films"):
        make_films(arguments.folder, arguments.shots)


if __name__ == "__main__":
    main()
