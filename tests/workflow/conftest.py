import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
import layer_show
import tiny_show

PROJECT = Path(__file__).parents[2]
COPIED = ("Snakefile", "workflow", "stages", "profiles", "pyproject.toml")


class Show:
    """A show in a folder, and the checkout that runs it."""

    def __init__(self, folder, checkout):
        self.folder, self.checkout = folder, checkout

    def snakemake(self, *arguments, cores=2):
        """Run the workflow; return the finished process."""
        command = [
            sys.executable,
            "-m",
            "snakemake",
            "--snakefile",
            str(self.checkout / "Snakefile"),
        ]
        command += ["--directory", str(self.folder), "--cores", str(cores), *arguments]
        environment = os.environ | {"PYTHONPATH": str(self.checkout)}
        # `-m` puts the working folder first on the path: it must hold no other `stages`
        return subprocess.run(
            command, cwd=self.folder, capture_output=True, text=True, env=environment, check=False
        )

    def would_run(self):
        """Return how many jobs of each rule a run would make."""
        planned = self.snakemake("--dry-run")
        assert planned.returncode == 0, planned.stderr
        text = planned.stdout + planned.stderr
        stats = re.findall(r"^(\w+) +(\d+)$", text, re.MULTILINE)
        return {rule: int(count) for rule, count in stats if rule not in ("all", "total")}

    def copy(self, folder):
        """Return the same show, finished, in another folder."""
        shutil.copytree(self.folder, folder)
        return Show(folder, self.checkout)


def checkout(folder):
    """Copy the project's code, so that a test may edit it."""
    folder.mkdir(parents=True)
    for name in COPIED:
        source = PROJECT / name
        copy = shutil.copytree if source.is_dir() else shutil.copy2
        copy(source, folder / name)
    return folder


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    """Return a show that has been run once; tests copy it before they change it."""
    folder = tmp_path_factory.mktemp("finished")
    show = Show(folder / "show", checkout(folder / "checkout"))
    tiny_show.build(show.folder)
    run = show.snakemake()
    assert run.returncode == 0, run.stdout + run.stderr
    return show


@pytest.fixture(scope="session")
def layered(tmp_path_factory):
    """Return a show of layers that has been run once; tests copy it before they change it."""
    folder = tmp_path_factory.mktemp("layered")
    show = Show(folder / "show", checkout(folder / "checkout"))
    layer_show.build(show.folder)
    run = show.snakemake()
    assert run.returncode == 0, run.stdout + run.stderr
    return show


@pytest.fixture
def show(finished, tmp_path):
    """Return a finished show that a test may change."""
    return finished.copy(tmp_path / "show")
