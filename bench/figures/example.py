"""Where the example show keeps its films and the workflow puts its results."""

from pathlib import Path

ACTOR = "ada"


def film(show: Path, shot: str) -> Path:
    """Return the film of a shot."""
    return show / "data_example" / "films" / f"{shot}.mp4"


def capture_film(show: Path) -> Path:
    """Return the film of the marker take."""
    return show / "data_example" / "capture" / "capture.mp4"


def truth(show: Path, shot: str) -> Path:
    """Return what the generator knows of a shot."""
    return show / "data_example" / "truth" / f"{shot}.npz"


def of_shot(show: Path, shot: str, name: str) -> Path:
    """Return a result of a shot, such as `expression.parquet`."""
    return show / "results" / "shots" / shot / name


def of_actor(show: Path, name: str) -> Path:
    """Return a result of the actor, such as `key_shapes.parquet`."""
    return show / "results" / "actors" / ACTOR / name


def of_take(show: Path, shot: str, character: str, name: str) -> Path:
    """Return a result of a take, such as `mesh.exr`."""
    return show / "results" / "takes" / shot / character / name


def rig(show: Path, character: str, actor: str = ACTOR) -> Path:
    """Return the rig of a character, as an actor plays it."""
    return show / "results" / "cast" / actor / character / "rig.npz"
