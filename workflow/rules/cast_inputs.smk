"""What the rules of characters and takes are given, by wildcards and tables. No rules."""


def character_row(name):
    """Return the row of a character."""
    return row_of(SHOW["characters"], "character", name)


def character_cell(column):
    """Return a function that gives a cell of the character's row."""

    def cell(wildcards):
        return character_row(wildcards.character)[column]

    return cell


def character_path(column):
    """Return a function that gives the path of a file in the character's folder, or a blank."""

    def path(wildcards):
        row = character_row(wildcards.character)
        return str(Path(row["folder"], row[column])) if row[column] else ""

    return path


def character_source(column):
    """Return a function that gives a file of the character's folder if it exists."""

    def source(wildcards):
        return present([character_path(column)(wildcards)])

    return source


def folder_of(name):
    """Return a function that gives a folder inside the character's own."""

    def folder(wildcards):
        return str(Path(character_row(wildcards.character)["folder"], name))

    return folder


def curve_channels(wildcards):
    """Return the table of a take's own curves; that of layers concerns their delivery."""
    layered = character_row(wildcards.character)["method"] == "layers"
    return "" if layered else character_path("channels")(wildcards)


def curve_channels_source(wildcards):
    """Return that table if it exists."""
    return present([curve_channels(wildcards)])


def sculpts(wildcards):
    """Return the sculpts of a character, sorted: editing, adding or removing one is noticed."""
    suffix = Path(character_row(wildcards.character)["neutral"]).suffix
    return files_of(wildcards.character, f"sculpts/*/*{suffix}")


def rig_shapes(wildcards):
    """Return the shapes of a character's rig, sorted; none where a GLB holds them all."""
    suffix = Path(character_row(wildcards.character)["neutral"]).suffix
    if suffix == ".glb":
        return []
    # a folder may mix mesh formats: none of its shapes is lost without a word
    kinds = (".csv",) if suffix == ".csv" else (".obj", ".ply")
    return sorted(sum((files_of(wildcards.character, f"shapes/*{kind}") for kind in kinds), []))


def pair_tables(wildcards):
    """Return the tables of a character's tuned pairs, one of each animator, sorted."""
    tables = [files_of(wildcards.character, f"pairs/*.{kind}") for kind in ("tsv", "csv")]
    return sorted(sum(tables, []))


def points_of(wildcards):
    """Return what drives a character when its actor plays: video points or markers."""
    if "shot" in wildcards.keys():
        actor = session_of(wildcards.shot)["actor"]
    else:
        actor = wildcards.actor
    played = rows_of(SHOW["cast"], "actor", actor)
    return next(row["points"] for row in played if row["character"] == wildcards.character)


def pair_shots(wildcards):
    """Return the names of the basis shots that pairs may come from."""
    rows = shots_of(wildcards.actor, points_of(wildcards), ["yes"])
    return [row["shot"] for row in rows]


def pair_expressions(wildcards):
    """Return the expressions of these shots."""
    return expand("results/shots/{shot}/expression.parquet", shot=pair_shots(wildcards))


def pair_cells(column):
    """Return a function that gives a column of these shots, a dash for a blank cell."""

    def values(wildcards):
        rows = shots_of(wildcards.actor, points_of(wildcards), ["yes"])
        return [row[column] or "-" for row in rows]

    return values


def pair_films(wildcards):
    """Return the films of these shots that exist."""
    return present(pair_cells("video")(wildcards))


def pair_phone_shots(wildcards):
    """Return the names of these shots whose phones are given or can be found."""
    rows = shots_of(wildcards.actor, points_of(wildcards), ["yes"])
    known = ("phones", "transcript", "words")
    return [row["shot"] for row in rows if any(row[column] for column in known)]


def pair_phones(wildcards):
    """Return these phones."""
    return expand("results/shots/{shot}/phones.parquet", shot=pair_phone_shots(wildcards))


def shots_of_pairs(wildcards):
    """Return the shot of every pair in these tables; what is wrong with them is said later."""
    found = []
    for path in pair_tables(wildcards):
        lines = Path(path).read_text(encoding="utf-8-sig", errors="replace").splitlines()
        header, *rows = [
            [cell.strip() for cell in re.split("[\t,]", line)] for line in lines or [""]
        ]
        place = header.index("shot") if "shot" in header else 0
        found += [row[place] for row in rows if len(row) > place]
    return found


def pair_count(wildcards):
    """Return how many pairs of the actor's basis shots there are."""
    shots = pair_shots(wildcards)
    return sum(name in shots for name in shots_of_pairs(wildcards))


def pair_starts(wildcards):
    """Return what the pairs so far make of these shots, or else the equation solve, if it can."""
    if pair_count(wildcards) >= regression_choice.FEWEST:
        method = "predicted"
    elif character_row(wildcards.character)["virtual_markers"]:
        method = "solved"
    else:
        return []
    take = f"results/takes/{{shot}}/{wildcards.character}/{method}.parquet"
    return expand(take, shot=pair_shots(wildcards))


def curve_pair_shots(wildcards):
    """Return the names of these shots for which curves were recorded too."""
    rows = shots_of(wildcards.actor, points_of(wildcards), ["yes"])
    return [row["shot"] for row in rows if row["curves"]]


def mapped_pair_shots(wildcards):
    """Return these curves on the character's rig."""
    take = f"results/takes/{{shot}}/{wildcards.character}/mapped.parquet"
    return expand(take, shot=curve_pair_shots(wildcards))


def other_pair_shots(wildcards):
    """Return the shots that pairs of this character name for other actors or points.

    Only those that are named: another actor's new shot must not train this one's pairs again.
    """
    own = cells(
        [row for row in SHOW["shots"] if row.cells["session"] in sessions_of(wildcards.actor)],
        "shot",
    )
    others = [name for name in cells(SHOW["shots"], "shot") if name not in own]
    kinds = [
        row["shot"]
        for points in ("video", "markers")
        for row in shots_of(wildcards.actor, points, ["yes"])
    ]
    used, named = pair_shots(wildcards), shots_of_pairs(wildcards)
    allowed = dict.fromkeys(others + [name for name in kinds if name not in used])
    return [name for name in allowed if name in named]


def regression_of(wildcards):
    """Return the trained regression of a take's actor and character."""
    actor = session_of(wildcards.shot)["actor"]
    return f"results/cast/{actor}/{wildcards.character}/rbf.npz"
