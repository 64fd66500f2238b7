"""Run the trials: `python -m bench` on the finished example show, `--data` on outside data.

A folder with `labels.csv` and `reference/` tries the tracker; one with `ict-facekit/`,
`facecap-head/` and `livelink/` tries key shapes and weights; a folder of such folders tries all.
Without data it takes about five minutes, most of them for `reruns`.
"""

import argparse
import subprocess
import sys
from pathlib import Path

EXAMPLE = ("example_truth", "glb_against_exr", "reruns")


def trials(show: Path, data: Path | None) -> list[tuple[str, list[str]]]:
    """Return module and arguments of every trial that the show and the data allow."""
    if data is None:
        takes = sorted(str(path.parent) for path in show.glob("results/takes/*/*/mesh.glb"))
        arguments = ([str(show)], takes, [str(show)])
        return list(zip(EXAMPLE, arguments, strict=True))
    found = []
    for folder in (data, *sorted(path for path in data.iterdir() if path.is_dir())):
        option = ["--data", str(folder)]
        if (folder / "labels.csv").is_file() and (folder / "reference").is_dir():
            found.append(("track_folder", option))
        if (folder / "ict-facekit").is_dir():
            found += [("key_shapes_trial", option), ("target_trial", option)]
    return found


def main() -> int:
    """Run the trials one after the other, each in a process of its own."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--show", type=Path, default=Path(), help="the example show, after a run")
    parser.add_argument("--data", type=Path, help="a folder of outside data")
    arguments = parser.parse_args()
    chosen = trials(arguments.show, arguments.data)
    if not chosen:
        sys.stderr.write(f"error: {arguments.data}: holds nothing to try; see bench/__main__.py\n")
        return 1
    worst = 0
    for module, options in chosen:
        sys.stdout.write(f"\n== {module.replace('_', ' ')}\n\n")
        sys.stdout.flush()
        run = subprocess.run([sys.executable, "-m", f"bench.{module}", *options], check=False)
        worst = max(worst, run.returncode)
    return worst


if __name__ == "__main__":
    sys.exit(main())
