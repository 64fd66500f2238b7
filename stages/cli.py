"""How every stage starts, logs and fails."""

import logging
import sys
from collections.abc import Callable, Sequence

logger = logging.getLogger("keyface")


def run_stage(main: Callable[[Sequence[str]], None]) -> None:
    """Run a stage's `main` on the command line; turn bad input into one line and exit code 1.

    `ValueError` (which `errors.InputError` is) and `OSError` are the input's fault;
    anything else is a bug and keeps its traceback.
    """
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stderr)
    try:
        main(sys.argv[1:])
    except (ValueError, OSError) as error:
        sys.stderr.write(f"error: {_one_line(error)}\n")
        raise SystemExit(1) from None


def _one_line(error: Exception) -> str:
    """Return the error's message on one line, with the file first."""
    if isinstance(error, FileNotFoundError):
        return f"{error.filename or error}: no such file; is the path right, is it made already?"
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return " ".join(str(error).split())


class Progress:
    """Show how far a long loop has come: a line every tenth, a live count on a terminal.

    Parameters
    ----------
    task : what is being done
    total : how many steps it has
    """

    def __init__(self, task: str, total: int):
        self.task, self.total, self.done, self.tenth = task, max(total, 1), 0, 0

    def step(self) -> None:
        """Count one step."""
        self.done += 1
        if sys.stderr.isatty():
            end = "\n" if self.done == self.total else ""
            sys.stderr.write(f"\r{self.task}: {self.done}/{self.total}{end}")
        elif self.done * 10 // self.total > self.tenth:
            self.tenth = self.done * 10 // self.total
            logger.info("%s: %d of %d", self.task, self.done, self.total)
