"""Run recorded files of other programs from the file to a baked mesh: `--data FOLDER`.

`python -m bench.real_files --data FOLDER` writes shows into a temporary folder, with nothing but
their tables, runs the workflow on them and prints a row for each take: frames, rate and last time
of what was read, frames with a face, remarks of the checks of curves and rig, what the solve leaves
of the points in face units (median of the frames), the worst distance of a baked vertex from the
float64 mesh in units of its size, and the seconds of its jobs. The folder is that of the data's
README; what it lacks is left out. Points drive the ICT rig by the rig's own 68 landmark vertices,
curves both rigs. Rates that a file does not say are assumed, and marked so. Exit code 1 if a take
is not baked, or off by more than 1e-5.
"""

import argparse
import csv
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bench import float64_mesh, real_rigs
from bench.exr_reader import read as read_exr
from stages.files import rig, series

ROOT = Path(__file__).resolve().parents[1]
TABLES = ROOT / "stages" / "tables"
TOLERANCE = 1e-5
ROW = "{:<34}{:<9}{:>7}{:>9}{:>9}{:>6}{:>9}{:>10}{:>10}{:>7}  {}\n"
SESSION = ("session", "actor", "neutral_shot", "neutral_frame", "source_rate")
CHARACTER = ("character", "method", "folder", "neutral", "unit", "up_axis", "pivot", "face_unit")


class Show(NamedTuple):
    """Hold what the tables of a show say.

    Attributes
    ----------
    name : of the show
    column : of shots.tsv that the files stand in
    shots : (shot, file, film or None) of each take
    one_session : whether all takes share their neutral
    assumed_rate : of files that do not say theirs, or blank
    tracker : whose point set it is
    """

    name: str
    column: str
    shots: list[tuple[str, Path, Path | None]]
    one_session: bool
    assumed_rate: str
    tracker: str


def shows(data: Path) -> list[Show]:
    """Return the shows that a folder of data allows."""
    grid, faces = data / "grid-s1", data / "pyfeat"
    tables = sorted((grid / "reference").glob("*.csv"))
    clips = [path for path in sorted((faces / "news_sample").glob("*.csv")) if path.stem.isdigit()]
    other = [path for path in [faces / "OpenFace_Test.csv"] if path.is_file()]
    takes = sorted((data / "livelink").glob("*.csv"))

    def named(paths: list[Path]) -> list[tuple[str, Path, Path | None]]:
        return [(path.stem, path, None) for path in paths]

    films = [(path.stem, path, grid / f"{path.stem}.mpg") for path in tables]
    made = [
        Show("wide", "landmarks", films, True, "", "mediapipe"),
        Show("py-feat", "landmarks", named(clips), False, "25", "mediapipe"),
        Show("OpenFace", "landmarks", named(other), False, "30", "ibug68"),
        Show("Live Link", "curves", named(takes), False, "", "ibug68"),
    ]
    return [show for show in made if show.shots]


def write_table(path: Path, header: tuple[str, ...], rows: list[tuple]) -> None:
    """Write a table of a show."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as stream:
        csv.writer(stream, delimiter="\t", lineterminator="\n").writerows([header, *rows])


def build(show: Show, folder: Path, rigs: list[real_rigs.Described]) -> list[tuple[str, str]]:
    """Write a show; return the shots and characters of its takes."""
    config = folder / "config"
    driven = rigs if show.column == "curves" else [one for one in rigs if len(one.landmarks)]
    sessions, shots = [], []
    for shot, path, film in show.shots:
        actor = "actor" if show.one_session else f"actor_{shot}"
        if not (show.one_session and sessions):
            sessions.append((actor, actor, shot, "0", show.assumed_rate))
        shots.append((shot, actor, str(path), str(film or ""), "yes"))
    write_table(config / "shots.tsv", ("shot", "session", show.column, "video", "basis"), shots)
    write_table(config / "sessions.tsv", SESSION, sessions)
    points = "curves" if show.column == "curves" else "video"
    cast = [(row[1], one.name, points) for row in sessions for one in driven]
    write_table(config / "cast.tsv", ("actor", "character", "points"), cast)
    header = (*CHARACTER, "virtual_markers", "head")
    described = []
    for one in driven:
        # curves need neither pairs nor virtual markers; only method rbf may do without the latter
        listed = "" if show.column == "curves" else f"{show.tracker}.tsv"
        method = "rbf" if show.column == "curves" else "blendshapes"
        face = ("cm", "y", "0 -10 -2", f"{one.face_unit:.6f}", listed, "apply")
        described.append((one.name, method, str(one.folder), "neutral.obj", *face))
    write_table(config / "characters.tsv", header, described)
    write_table(config / "key_shapes.tsv", ("actor", "region", "shot", "frame", "state"), [])
    settings = [("mouth", "2"), ("eyes", "2")]
    write_table(config / "region_settings.tsv", ("region", "count"), settings)
    shutil.copy(TABLES / "point_sets" / f"{show.tracker}.tsv", config / "point_set.tsv")
    shutil.copy(TABLES / "regions" / f"{show.tracker}.tsv", config / "regions.tsv")
    shutil.copy(ROOT / "config" / "config.yaml", config)
    return [(shot, one.name) for shot, *_ in show.shots for one in driven]


def run(folder: Path, takes: list[tuple[str, str]]) -> list[str]:
    """Run the workflow up to the baked meshes; return the lines of its errors."""
    targets = [f"results/takes/{shot}/{name}/mesh.exr" for shot, name in takes]
    actors = {row["actor"]: row["character"] for row in _rows(folder / "config" / "cast.tsv")}
    targets += [f"results/cast/{actor}/{name}/rig_checks.tsv" for actor, name in actors.items()]
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    command += ["--directory", str(folder), "--cores", "1", "--keep-going", *targets]
    place = {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        command, check=False, capture_output=True, text=True, env=os.environ | place
    )
    return [line for line in done.stderr.splitlines() if line.startswith("error: ")]


def _rows(path: Path) -> list[dict[str, str]]:
    """Return the rows of a show's table."""
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream, delimiter="\t"))


def report(show: Show, folder: Path, take: tuple[str, str], said: list[str]) -> bool:
    """Print the row of a take; return whether it is baked and true."""
    shot, name = take
    source = f"{show.name}: {shot}"[:33]
    made = folder / "results" / "takes" / shot / name
    if not (made / "mesh.exr").is_file():
        why = next((line for line in said if shot in line or name in line), "not baked")
        sys.stdout.write(ROW.format(source, name, *["-"] * 8, why))
        return False
    where, kind = _imported(show, folder / "results" / "shots" / shot)
    found = series.read(where, kind)
    seen = np.count_nonzero(found.columns["confidence"] > 0)
    reported = _reported(folder, shot, name)
    worst = error(made, folder, name)
    spent = sum(seconds(path) for path in (folder / "logs").rglob("*.tsv") if _is_of(path, take))
    assumed = "" if show.column == "curves" or not show.assumed_rate else "*"
    rate = f"{float(found.rate):.6g}{assumed}"
    last = f"{found.time_s[-1]:.3f}"
    cells = len(found.frame), rate, last, seen, reported, left(made), f"{worst:.1e}", f"{spent:.1f}"
    well = worst <= TOLERANCE
    sys.stdout.write(ROW.format(source, name, *cells, "baked" if well else "WRONG"))
    return well


def _imported(show: Show, shot: Path) -> tuple[Path, str]:
    """Return what was made of the file, and its kind."""
    if show.column == "curves":
        return shot / "curves.parquet", "curves"
    return shot / "imported.parquet", "tracked"


def _is_of(path: Path, take: tuple[str, str]) -> bool:
    """Say whether a benchmark's table is that of a job of the shot, or of the take."""
    parts = [*path.parts[:-1], path.stem]
    return take[0] in parts and (take[1] in parts or path.stem == take[0])


def seconds(path: Path) -> float:
    """Return the seconds of a job, from the table that Snakemake writes."""
    return float(path.read_text().splitlines()[1].split("\t")[0])


def left(made: Path) -> str:
    """Return what the solve of a take leaves, median of the frames; curves are not solved for."""
    if not (made / "solved.parquet").is_file():
        return "-"
    residual = series.read(made / "solved.parquet", "solved").columns["residual"]
    return f"{np.nanmedian(residual):.4f}"


def _reported(folder: Path, shot: str, name: str) -> int:
    """Return how many remarks the checks of curves and of the rig made."""
    found = [*(folder / "results" / "shots" / shot).glob("curve_checks.tsv")]
    found += sorted((folder / "results" / "cast").glob(f"*/{name}/rig_checks.tsv"))[:1]
    return sum(len(path.read_text().splitlines()) - 1 for path in found)


def error(made: Path, folder: Path, name: str) -> float:
    """Return how far baked vertices are from the float64 mesh, in units of its size."""
    rigs = sorted((folder / "results" / "cast").glob(f"*/{name}/rig.npz"))
    truth = float64_mesh.positions(rigs[0], made / "weights.parquet")[1]
    count = len(rig.read(rigs[0], "mesh").neutral)
    baked = read_exr(made / "mesh.exr").reshape(len(truth), -1, 3)[:, :count]
    size = np.linalg.norm(np.ptp(truth.reshape(-1, 3), axis=0))
    return max(
        float(np.linalg.norm(one - two, axis=1).max())
        for one, two in zip(baked, truth, strict=True)
    ) / float(size)


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True, help="the folder")
    data = parser.parse_args().data.resolve()
    head = "file", "rig", "frames", "rate", "last [s]", "seen", "remarks", "residual", "worst"
    sys.stdout.write(ROW.format(*head, "[s]", "status"))
    well = True
    with tempfile.TemporaryDirectory() as temporary:
        rigs = real_rigs.write(data, Path(temporary))
        for number, show in enumerate(shows(data)):
            folder = Path(temporary) / f"show_{number}"
            takes = build(show, folder, rigs)
            said = run(folder, takes)
            for take in takes:
                well &= report(show, folder, take, said)
                sys.stdout.flush()
    sys.stdout.write("* assumed: the file does not say it\n")
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
