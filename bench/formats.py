"""Write a take in every format, read each back by a reader that is not its writer, and compare.

`python -m bench.formats results/takes/talk/human ...` prints, for every format and reader, the
worst distance of a vertex over all frames from the float64 mesh in units of the character's size,
frames, and the last frame's time. `--blender /path/to/python` adds
Blender, any Python that has `bpy`; `--three node_modules/three` adds three.js, after `npm install
three` in any folder, in the Chromium that `--chromium` names.
Exit code 1 if a float format is off by more than 1e-5, a texture by more than it states, or a frame
or time is lost.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import stages
from bench import float64_mesh, format_readers, three_reader
from stages import (
    bake_mesh,
    export_blender,
    export_mdd,
    export_obj,
    export_texture,
    export_usd,
)
from stages.files import rig

TOLERANCE = 1e-5
CHROMIUM = "chromium"
TEMPLATES = Path(stages.__file__).parent / "templates"
BLENDER = {
    "glb": "mesh.glb",
    "usd": "mesh.usdc",
    "points": "points.usdc",
    "pc2": "mesh.pc2",
    "mdd": "mesh.mdd",
    "obj": "obj/",
    "script": "blender.py",
}
ROW = "{:<22}{:<16}{:>14}{:>12}{:>8}{:>14}  {}\n"


def words(**options: object) -> list[str]:
    """Return a command line of flags and values."""
    flags = [name.replace("_", "-") for name in options]
    return [
        word
        for flag, value in zip(flags, options.values(), strict=True)
        for word in (f"--{flag}", str(value))
    ]


def write(folder: Path, rig_path: Path, weights_path: Path) -> None:
    """Write every format into a folder."""
    moved = words(rig=rig_path, weights=weights_path)
    mesh = {kind: folder / f"mesh.{kind}" for kind in ("exr", "json", "pc2", "glb")}
    bake_mesh.main([*moved, *words(**mesh)])
    baked = words(exr=mesh["exr"], json=mesh["json"])
    export_mdd.main([*baked, *words(mdd=folder / "mesh.mdd")])
    export_obj.main([*baked, *words(rig=rig_path, obj_folder=folder / "obj")])
    export_usd.main([*moved, *words(usd=folder / "mesh.usdc", points=folder / "points.usdc")])
    template = TEMPLATES / "apply_in_blender.py"
    export_blender.main([*moved, *words(template=template, script=folder / "blender.py")])
    for kind in ("float", "half", "openvat"):
        where = folder / kind
        layout = "openvat" if kind == "openvat" else "plain"
        depth = "float" if kind == "float" else "half"
        files = {"texture": "texture.exr", "normals": "texture_normals.exr"}
        files |= {"texture_json": "texture.json", "texture_mesh": "texture_mesh.obj"}
        paths = {name: where / file for name, file in files.items()}
        options = words(rig=rig_path, layout=layout, depth=depth, **paths)
        export_texture.main([*baked, *options])


def stated(folder: Path, size: float) -> float:
    """Return the error that a texture states, in units of the size."""
    document = json.loads((folder / "texture.json").read_text())
    return document.get("keyface", document)["quantisation"]["max_distance"] / size


def compare(
    names: tuple[str, str], found: format_readers.Found, truth: format_readers.Found, allowed: float
) -> bool:
    """Print a row; return whether all is well."""
    (times, positions), (wanted_times, wanted) = found, truth
    size = np.linalg.norm(np.ptp(wanted.reshape(-1, 3), axis=0))
    same = positions.shape == wanted.shape
    worst = np.linalg.norm(positions - wanted, axis=2).max() / size if same else np.inf
    step = wanted_times[-1] / max(len(wanted_times) - 1, 1)
    in_time = same and np.abs(times - wanted_times).max() < 1e-3 * step
    well = worst <= allowed and in_time
    cells = f"{worst:.2e}", f"{allowed:.1e}", len(positions), f"{times[-1]:.6f}"
    sys.stdout.write(ROW.format(*names, *cells, "" if well else "WRONG"))
    return bool(well)


def blender_rows(python: str, folder: Path, rig_path: Path) -> list[tuple[str, Path]]:
    """Let Blender import what was written; return the name and result of each format."""
    character = rig.read(rig_path, "mesh")
    np.savez(
        folder / "character.npz",
        neutral=character.neutral,
        sizes=character.sizes,
        corners=character.corners,
        shapes=float64_mesh.full_shapes(character),
        names=np.array(character.names),
        up=character.up_axis,
        metres=rig.METRES[character.unit],
    )
    reader = Path(__file__).with_name("blender_reader.py")
    run = subprocess.run([python, str(reader), str(folder)], check=False, capture_output=True)
    said = [line for line in run.stdout.decode().splitlines() if line.startswith("blender ")]
    sys.stdout.write("".join(f"{line}\n" for line in said))
    if run.returncode:
        sys.stdout.write(run.stderr.decode()[-2000:])
    return [(name, folder / f"blender_{kind}.npz") for kind, name in BLENDER.items()]


def three_row(
    three: Path, chromium: str, folder: Path, truth: format_readers.Found
) -> tuple[str, format_readers.Found]:
    """Let three.js play the GLB; return its name and what it found."""
    played = three_reader.play(folder / "mesh.glb", three, chromium, truth[0])
    found = played.positions @ format_readers.out_of_gltf(folder).T
    return f"three.js r{played.revision}", (played.times, found)


def check(
    take: Path,
    folder: Path,
    blender: str | None = None,
    three: Path | None = None,
    chromium: str = CHROMIUM,
) -> bool:
    """Write and read one take; return whether all is well."""
    rig_path = float64_mesh.rig_of(take)
    write(folder, rig_path, take / "weights.parquet")
    truth = float64_mesh.positions(rig_path, take / "weights.parquet")
    size = float(np.linalg.norm(np.ptp(truth[1].reshape(-1, 3), axis=0)))
    sys.stdout.write(f"\n{take}: {truth[1].shape[1]} vertices, {len(truth[0])} frames\n\n")
    head = "format", "reader", "worst error", "allowed", "frames", "last time [s]", ""
    sys.stdout.write(ROW.format(*head))
    well = True
    for name, reader, read in format_readers.READERS:
        kind = name.removeprefix("texture.exr ")
        allowed = stated(folder / kind, size) if kind != name else TOLERANCE
        well &= compare((name, reader), read(folder), truth, allowed)
    if three:
        reader, found = three_row(three, chromium, folder, truth)
        well &= compare(("mesh.glb", reader), found, truth, TOLERANCE)
    for name, path in blender_rows(blender, folder, rig_path) if blender else []:
        if path.is_file():
            read = np.load(path)
            found = read["times"], read["positions"]
            well &= compare((name, "Blender"), found, truth, TOLERANCE)
        else:
            well = False
    return well


def main() -> None:
    """Check every take that is named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("takes", type=Path, nargs="+", help="folders of takes of a finished show")
    parser.add_argument("--blender", help="a Python with bpy, to read with Blender too")
    parser.add_argument("--three", type=Path, help="a folder of three.js, to play the GLB with it")
    parser.add_argument("--chromium", default=CHROMIUM, help="the browser that three.js runs in")
    options = parser.parse_args()
    well = True
    for take in options.takes:
        with tempfile.TemporaryDirectory() as folder:
            chosen = options.blender, options.three, options.chromium
            well &= check(take.resolve(), Path(folder), *chosen)
    raise SystemExit(0 if well else 1)


if __name__ == "__main__":
    main()
