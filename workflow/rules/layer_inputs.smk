"""What the rules of method layers are given, by wildcards and tables. No rules."""


def layer_characters(column, *values):
    """Return the pattern of the characters driven by layers whose cell holds one of some values."""
    rows = [row.cells for row in SHOW["characters"] if row.cells["method"] == "layers"]
    return "|".join(row["character"] for row in rows if row[column] in values) or "-"


def delivered_on_blendshapes():
    """Return the pattern of the characters whose layers are projected onto blendshapes."""
    rows = [row.cells for row in SHOW["characters"] if row.cells["method"] == "layers"]
    return "|".join(row["character"] for row in rows if row["delivery_shapes"]) or "-"


def poses(wildcards):
    """Return a character's poses, sorted: editing, adding or removing one is noticed."""
    suffix = Path(character_row(wildcards.character)["neutral"]).suffix
    kinds = (".csv",) if suffix == ".csv" else (".obj", ".ply", ".csv")
    return sorted(sum((files_of(wildcards.character, f"poses/*{kind}") for kind in kinds), []))


def blendshapes_of_poses(wildcards):
    """Return the artist's blendshapes, of which poses may be tables of weights."""
    folder = character_row(wildcards.character)["delivery_shapes"] or "shapes"
    kinds = ("obj", "ply")
    return sorted(sum((files_of(wildcards.character, f"{folder}/*.{k}") for k in kinds), []))


def delivery_folder(wildcards):
    """Return the folder of a character's blendshapes for delivery."""
    row = character_row(wildcards.character)
    return str(Path(row["folder"], row["delivery_shapes"]))


def delivery_rig_of(wildcards):
    """Return the blendshapes onto which a take is projected, as a rig."""
    actor = session_of(wildcards.shot)["actor"]
    return f"results/cast/{actor}/{wildcards.character}/delivery_rig.npz"


def layer_shots(wildcards):
    """Return the basis shots in which an actor's extremes are seen, for a character's points."""
    named = [row["shot"] for row in rows_of(SHOW["expressions"], "actor", wildcards.actor)]
    rows = shots_of(wildcards.actor, points_of(wildcards), ["yes"])
    return [row["shot"] for row in rows if row["shot"] in named]


def layer_expressions(wildcards):
    """Return the expressions of these shots."""
    return expand("results/shots/{shot}/expression.parquet", shot=layer_shots(wildcards))


def layer_tables(wildcards):
    """Return the tables of extremes and masks that exist: extremes are proposed before any is."""
    return present(["config/expressions.tsv", "config/actor_masks.tsv"])


def rows_as_text(name, **wanted):
    """Return some rows of a table as texts: only they change what depends on them."""
    rows = [
        row.cells
        for row in SHOW[name]
        if all(row.cells[column] in values for column, values in wanted.items())
    ]
    return [":".join(row.values()) for row in rows]


def expression_rows(wildcards):
    """Return an actor's rows of expressions.tsv."""
    return rows_as_text("expressions", actor=[wildcards.actor])


def actor_mask_rows(wildcards):
    """Return an actor's rows of actor_masks.tsv."""
    return rows_as_text("actor_masks", actor=[wildcards.actor])


def directing_rows(wildcards):
    """Return the rows of directing.tsv that concern a take."""
    character, shots = [wildcards.character], ["", wildcards.shot]
    return rows_as_text("directing", character=character, shot=shots)


def directing_path(wildcards):
    """Return the path of the table of gains, or a blank for takes that it does not mention."""
    return "config/directing.tsv" if directing_rows(wildcards) else ""


def directing_source(wildcards):
    """Return the table of gains for the takes that it mentions."""
    return present([directing_path(wildcards)])


def lip_points_of_actor(wildcards):
    """Return the lip points of the session in which an actor's extremes are seen."""
    shots = layer_shots(wildcards)
    return session_of(shots[0])["lip_points"] if shots else ""


def simplices_of(wildcards):
    """Return the extremes that a take's actor and character share."""
    actor = session_of(wildcards.shot)["actor"]
    return f"results/cast/{actor}/{wildcards.character}/simplices.npz"


def layer_outputs(shot, character):
    """Return the further files of a take that layers drive."""
    row, folder = character_row(character), f"results/takes/{shot}/{character}"
    if row["method"] != "layers":
        return []
    wanted = [f"{folder}/layers/{layer}.csv" for layer in ("emotion", "speech", "blink")]
    return wanted + ([f"{folder}/delivery.parquet"] if row["delivery_shapes"] else [])


def proposal_points(wildcards):
    """Return the points by which an actor's extremes are proposed: what drives the layers."""
    return proposing(wildcards.actor)


def proposing(actor):
    """Return the points of an actor's first character that layers drive, or nothing."""
    played = rows_of(SHOW["cast"], "actor", actor)
    layered = [row for row in played if character_row(row["character"])["method"] == "layers"]
    return layered[0]["points"] if layered else ""


def proposal_rows(wildcards):
    """Return the rows of the basis shots in which extremes are looked for."""
    return shots_of(wildcards.actor, proposing(wildcards.actor), ["yes"])


def proposal_shots(wildcards):
    """Return the names of these shots."""
    return [row["shot"] for row in proposal_rows(wildcards)]


def proposal_expressions(wildcards):
    """Return their expressions."""
    return expand("results/shots/{shot}/expression.parquet", shot=proposal_shots(wildcards))


def proposal_cells(column):
    """Return a function that gives a column of these shots, a dash for a blank cell."""

    def values(wildcards):
        return [row[column] or "-" for row in proposal_rows(wildcards)]

    return values


def proposal_films(wildcards):
    """Return the films of these shots that exist."""
    return present(proposal_cells("video")(wildcards))


def proposal_phone_shots(wildcards):
    """Return the names of these shots whose phones are given or can be found."""
    known = ("phones", "transcript", "words")
    return [row["shot"] for row in proposal_rows(wildcards) if any(row[c] for c in known)]


def proposal_phones(wildcards):
    """Return these phones."""
    return expand("results/shots/{shot}/phones.parquet", shot=proposal_phone_shots(wildcards))


def lid_points_of_actor(wildcards):
    """Return the markers of the lids, of the session of the first of these shots."""
    return session_of(proposal_shots(wildcards)[0])["lid_points"]


def expression_pages():
    """Return the proposed extremes of everyone who drives layers."""
    actors = dict.fromkeys(row.cells["actor"] for row in SHOW["cast"])
    wanted = [actor for actor in actors if proposing(actor)]
    return expand("results/actors/{actor}/expressions/index.html", actor=wanted)
