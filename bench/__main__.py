"""Run the trials: `python -m bench` on the example show, with `--data` on outside data too."""

import argparse
import sys
from pathlib import Path

from bench import example_truth


def main() -> None:
    """Print the figures of every trial that the given data allows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--show", type=Path, default=Path(), help="the example show, after a run")
    parser.add_argument("--data", type=Path, help="a folder of outside data")
    arguments = parser.parse_args()
    sys.stdout.write("Example show against rendered truth\n")
    sys.stdout.write("\n".join(example_truth.table(arguments.show)) + "\n")


if __name__ == "__main__":
    main()
