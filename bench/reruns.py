"""Time what a run makes again after each kind of edit, on a copy of the finished example show."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

LEFT_OUT = shutil.ignore_patterns(".venv", ".git", "__pycache__", "figures")
SCULPT = "data_example/characters/radio/sculpts/mouth"
CORE = "stages/core/planar_motion.py"


def table(show: Path) -> list[str]:
    """Return the lines of a table: edit, wall time, jobs by rule."""
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "show"
        shutil.copytree(show, copy, ignore=LEFT_OUT, symlinks=True)
        _run(copy)
        for name, change in EDITS.items():
            change(copy)
            seconds, jobs = _run(copy)
            made = ", ".join(f"{rule} {count}" for rule, count in sorted(jobs.items()))
            lines.append(f"{name:34} {seconds:6.1f} s  {made or 'nothing'}")
    return lines


def _run(folder: Path) -> tuple[float, Counter]:
    """Run the workflow on two cores; return wall time [s] and finished jobs by rule."""
    command = [sys.executable, "-m", "snakemake", "--cores", "2", "--keep-going"]
    environment = os.environ | {"PYTHONPATH": str(folder)}
    start = time.perf_counter()
    run = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    finished = re.findall(r"Finished jobid: \d+ \(Rule: (\w+)\)", run.stderr + run.stdout)
    return time.perf_counter() - start, Counter(rule for rule in finished if rule != "all")


def _replace(path: Path, old: str, new: str) -> None:
    """Replace the first occurrence of a text in a file."""
    text = path.read_text(encoding="utf-8")
    if old not in text:
        raise ValueError(f"{path}: holds no '{old}'")
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def _sculpt(folder: Path) -> Path:
    """Return the first sculpt of the radio's mouth."""
    return sorted((folder / SCULPT).glob("*.obj"))[0]


def _edit_sculpt(folder: Path) -> None:
    """Move the first vertex of a sculpt."""
    path = _sculpt(folder)
    first = re.search(r"^v (\S+)", path.read_text(encoding="utf-8"), re.MULTILINE).group(1)
    _replace(path, f"v {first}", f"v {float(first) + 0.001:.6f}")


def _take_away(folder: Path) -> None:
    """Put a sculpt aside."""
    path = _sculpt(folder)
    path.rename(folder / path.name)


def _put_back(folder: Path) -> None:
    """Bring the sculpt back that was put aside."""
    (path,) = folder.glob("*.obj")
    path.rename(folder / SCULPT / path.name)


def _add_shot(folder: Path) -> None:
    """Add the talking film once more under another name."""
    films = folder / "data_example" / "films"
    shutil.copy(films / "talk.mp4", films / "again.mp4")
    with (folder / "config" / "shots.tsv").open("a", encoding="utf-8") as stream:
        stream.write("again\tday1\tdata_example/films/again.mp4\t\tno\n")


def _widen_basis(folder: Path) -> None:
    """Make the strong head motion a basis shot: one cell of shots.tsv."""
    path = folder / "config" / "shots.tsv"
    (row,) = [line for line in path.read_text(encoding="utf-8").splitlines() if "turn.mp4" in line]
    _replace(path, row, row.removesuffix("no") + "yes")


EDITS: dict[str, Callable[[Path], None]] = {
    "nothing": lambda _: None,
    "one sculpt edited": _edit_sculpt,
    "one sculpt removed": _take_away,
    "the sculpt put back": _put_back,
    "a core file's comment changed": lambda f: _replace(f / CORE, '"""Head', '"""The head'),
    "a core file's code changed": lambda f: _replace(f / CORE, "ROUNDS = 3", "ROUNDS = 2 + 1"),
    "a shot added": _add_shot,
    "one cell of shots.tsv changed": _widen_basis,
}


if __name__ == "__main__":
    sys.stdout.write("\n".join(table(Path(sys.argv[1] if len(sys.argv) > 1 else "."))) + "\n")
