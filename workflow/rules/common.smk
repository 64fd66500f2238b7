"""Tables, their validation, wildcards and input functions; no rules."""

import re
import shlex
import sys
from pathlib import Path

import jsonschema
import yaml

from stages.core import regression_choice
from stages.files import (
    directing_table,
    errors,
    expressions,
    extremes,
    regions,
    show,
    source_code,
    tempo_text,
)

# the stages run with the Python that runs Snakemake, wherever that was started
shell.prefix(f"export PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; ")

SCHEMAS = Path(workflow.basedir) / "workflow" / "schemas"
NAME = "[A-Za-z0-9][A-Za-z0-9_-]*"


wildcard_constraints:
    session=NAME,
    shot=NAME,
    actor=NAME,
    character=NAME,


def code_of(stage):
    """Return the fingerprint of a stage's code: a job runs again when it changes."""
    return source_code.digest(f"stages.{stage}")[:16]


def present(paths):
    """Return the sources that exist: a missing one fails its own job, not the whole run."""
    return [path for path in paths if path and Path(path).exists()]


def template(name):
    """Return the path of a page's template, an input like any other."""
    return str(Path(workflow.basedir, "stages", "templates", name).resolve())


def data_table(name):
    """Return the path of a shipped table, an input like any other."""
    return str(Path(workflow.basedir, "stages", "tables", name).resolve())


def landmark_maps():
    """Return the shipped tables that name other trackers' points."""
    folder = Path(workflow.basedir, "stages", "tables", "landmarks").resolve()
    return sorted(map(str, folder.glob("*.tsv")))


def table(name):
    """Read and validate one table of the show; those of method layers may be missing."""
    path = Path("config", f"{name}.tsv")
    if name in ("expressions", "actor_masks", "directing") and not path.exists():
        return []
    return show.read(str(path), SCHEMAS / f"{name}.yaml")


def cells(rows, column):
    """Return a column of some rows."""
    return [row.cells[column] for row in rows]


def row_of(rows, column, value):
    """Return the cells of the one row whose column holds a value."""
    return next(row.cells for row in rows if row.cells[column] == value)


def rows_of(rows, column, value):
    """Return the cells of all rows whose column holds a value."""
    return [row.cells for row in rows if row.cells[column] == value]


def validated_show():
    """Read every table of the show; stop with one line at the first fault."""
    try:
        settings = yaml.safe_load((SCHEMAS / "config.yaml").read_text(encoding="utf-8"))
        for name, setting in settings["properties"].items():
            if "default" in setting:
                config.setdefault(name, setting["default"])
        for fault in jsonschema.Draft202012Validator(settings).iter_errors(config):
            place = ".".join(map(str, fault.path)) or "top level"
            raise errors.InputError("config/config.yaml", f"{place}: {fault.message}")
        tables = {name: table(name) for name in TABLES}
        face_regions = regions.read("config/regions.tsv")
        check_references(tables, face_regions)
        check_sense(tables, face_regions)
        return tables, face_regions
    except errors.InputError as error:
        sys.exit(f"error: {error}")


# every table, and its columns that refer to another one
TABLES = {
    "sessions": ["neutral_shot"],
    "shots": ["session"],
    "region_settings": ["region"],
    "key_shapes": ["actor", "region", "shot"],
    "characters": [],
    "cast": ["actor", "character", "shots"],
    "expressions": ["actor", "shot"],
    "actor_masks": ["actor"],
    "directing": ["character"],
}
SHOW, REGIONS = validated_show()


def sessions_of(actor):
    """Return the names of an actor's sessions."""
    return [row["session"] for row in rows_of(SHOW["sessions"], "actor", actor)]


def shots_of(actor, points, basis=("yes", "no")):
    """Return the rows of an actor's shots that have video points, or markers, in order."""
    wanted = sessions_of(actor)
    shots = [row.cells for row in SHOW["shots"] if row.cells["session"] in wanted]
    return [shot for shot in shots if shot["basis"] in basis and has_points(SHOW, shot, points)]


def session_of(shot):
    """Return the row of a shot's session."""
    name = row_of(SHOW["shots"], "shot", shot)["session"]
    return row_of(SHOW["sessions"], "session", name)


def cast_takes():
    """Return (shot, character) of every take that the cast asks for."""
    takes = []
    for row in SHOW["cast"]:
        wanted = show.listed(row.cells["shots"])
        for shot in shots_of(row.cells["actor"], row.cells["points"]):
            if not wanted or shot["shot"] in wanted:
                takes.append((shot["shot"], row.cells["character"]))
    return takes


def of_method(*methods):
    """Return the pattern of the characters that are driven by one of some methods."""
    rows = [row.cells for row in SHOW["characters"]]
    return "|".join(row["character"] for row in rows if row["method"] in methods) or "-"


def solvable():
    """Return the pattern of the characters whose virtual markers are known."""
    rows = [row.cells for row in SHOW["characters"]]
    return "|".join(row["character"] for row in rows if row["virtual_markers"]) or "-"


def of_kind(kind):
    """Return the pattern of the characters that are a mesh, or a table of controls."""
    rows = [row.cells for row in SHOW["characters"]]
    wanted = kind == "controls"
    return "|".join(r["character"] for r in rows if r["neutral"].endswith(".csv") == wanted) or "-"


def files_of(character, pattern):
    """Return the files in a character's folder that fit a pattern, sorted."""
    row = row_of(SHOW["characters"], "character", character)
    return sorted(str(path) for path in Path(row["folder"]).glob(pattern) if path.is_file())
