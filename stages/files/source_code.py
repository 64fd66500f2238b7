"""The fingerprint of a stage's code, by which the workflow knows that an edit changes results.

Snakemake sees the command of a job, not the Python modules behind it. The digest covers the
syntax tree of a module and of every `stages` module that it reaches by import, so that comments
and layout change nothing and code does. It relies on the convention that imports of `stages`
stand at a module's top.
"""

import ast
import functools
import hashlib
from pathlib import Path

PACKAGE = "stages"
PACKAGE_FOLDER = Path(__file__).parents[1]


def _source_of(module: str) -> Path | None:
    """Return the file of a module; None where the name is none, or a package (which is empty)."""
    path = PACKAGE_FOLDER.joinpath(*module.split(".")[1:])
    return path.with_suffix(".py") if path.with_suffix(".py").is_file() else None


@functools.cache
def parsed(module: str) -> tuple[str, tuple[str, ...]]:
    """Return the dump of a module's syntax tree without docstrings, and what it imports."""
    tree = ast.parse(_source_of(module).read_text(encoding="utf-8"))
    imported = []
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == PACKAGE:
            imported += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.Import):
            imported += [a.name for a in node.names if a.name.split(".")[0] == PACKAGE]
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list) and body and _is_text(body[0]):
            node.body = body[1:]
    return ast.dump(tree), tuple(name for name in imported if _source_of(name))


def _is_text(node: ast.AST) -> bool:
    """Tell whether a statement is only a string, as a docstring is."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


def modules_reached(module: str) -> list[str]:
    """Return a module and all modules of the package that it reaches by import, sorted."""
    reached, waiting = set(), [module]
    while waiting:
        name = waiting.pop()
        if name not in reached:
            reached.add(name)
            waiting += parsed(name)[1]
    return sorted(reached)


def digest(module: str) -> str:
    """Return the sha256 over the code of a module and of all that it reaches by import."""
    sums = hashlib.sha256()
    for name in modules_reached(module):
        sums.update(f"{name}\0{parsed(name)[0]}\0".encode())
    return sums.hexdigest()
