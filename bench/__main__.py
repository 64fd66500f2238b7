"""Run the trials: `python -m bench` on the finished example show, `--data` on outside data.

A folder with `labels.csv` and `reference/` tries the tracker; one with films and `.align` files
sound sync and phones; one with `ict-facekit/`, `facecap-head/` and `livelink/` key shapes, weights,
markers, head motion, regressions, filters, dynamics and layers; a folder of such folders tries all.
Without data it takes about a quarter of an hour, with data more than one hour.
"""

import argparse
import subprocess
import sys
from pathlib import Path

RIGS = (
    "key_shapes_trial",
    "target_trial",
    "marker_trial",
    "head_motion_trial",
    "equation_trial",
    "rbf_trial",
    "filter_trial",
    "key_reduction_trial",
    "dynamics_trial",
    "layer_trial",
    "real_files",
)
SPEECH = ("sync_trial", "phone_trial")


def trials(show: Path, data: Path | None) -> list[tuple[str, list[str]]]:
    """Return module and arguments of every trial that the show and the data allow."""
    if data is None:
        takes = sorted(str(path.parent) for path in show.glob("results/takes/*/*/mesh.glb"))
        example = [("example_truth", [str(show)]), ("rig_truth", [str(show)])]
        example += [("glb_against_exr", takes), ("large_bake", []), ("large_rig", [])]
        example += [("layer_trial", []), ("layer_balance", [str(show)])]
        return [*example, ("layer_example", [str(show)]), ("reruns", [str(show)])]
    found = []
    for folder in (data, *sorted(path for path in data.iterdir() if path.is_dir())):
        option = ["--data", str(folder)]
        if (folder / "labels.csv").is_file() and (folder / "reference").is_dir():
            found.append(("track_folder", option))
        if any(folder.glob("*.align")):
            found += [(name, option) for name in SPEECH]
        if (folder / "ict-facekit").is_dir():
            found += [(name, option) for name in RIGS]
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
