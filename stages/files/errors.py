"""The error that every reader raises for input that a person has to mend."""

from pathlib import Path


class InputError(ValueError):
    """Say in one line which file is wrong, where in it, and what to do.

    Parameters
    ----------
    path : path of the file as the person wrote it
    message : what was found, at which place, and the cure
    """

    def __init__(self, path: str | Path, message: str):
        super().__init__(f"{path}: {message}")
