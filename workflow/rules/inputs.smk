"""What the rules are given, by wildcards and tables: targets, inputs and params. No rules."""


def label_proposals():
    """Return the proposals of every session."""
    sessions = cells(SHOW["sessions"], "session")
    return expand("results/sessions/{session}/label_proposals.tsv", session=sessions)


def labelled(column):
    """Return a function that lists a column of a session's labelled shots."""

    def values(wildcards):
        rows = rows_of(SHOW["shots"], "session", wildcards.session)
        return [row[column] for row in rows if row["labels"]]

    return values


def training_sources(wildcards):
    """Return the films and label tables of a session that exist."""
    return present(labelled("video")(wildcards) + labelled("labels")(wildcards))


def film_path(wildcards):
    """Return the film of a shot."""
    return row_of(SHOW["shots"], "shot", wildcards.shot)["video"]


def film(wildcards):
    """Return the film of a shot if it exists."""
    return present([film_path(wildcards)])


def session_shots(wildcards):
    """Return the names of a session's shots."""
    return [row["shot"] for row in rows_of(SHOW["shots"], "session", wildcards.session)]


def session_tracked(wildcards):
    """Return the tracked points of a session's shots."""
    return expand("results/shots/{shot}/tracked.parquet", shot=session_shots(wildcards))


def tracker_of(wildcards):
    """Return the tracker of a shot's session."""
    return f"results/sessions/{session_of(wildcards.shot)['session']}/tracker.npz"


def neutral_of(wildcards):
    """Return the points of the shot that shows the session's neutral."""
    return f"results/shots/{session_of(wildcards.shot)['neutral_shot']}/performance.parquet"


def session_cell(column):
    """Return a function that gives a cell of the shot's session."""

    def cell(wildcards):
        return session_of(wildcards.shot)[column]

    return cell


def briefs():
    """Return the brief of every actor."""
    actors = sorted(set(cells(SHOW["sessions"], "actor")))
    return expand("results/actors/{actor}/brief/index.html", actor=actors)


def basis_shots(wildcards):
    """Return the names of an actor's basis shots."""
    return [row["shot"] for row in shots_of(wildcards.actor, basis=["yes"])]


def basis_expressions(wildcards):
    """Return the expressions of an actor's basis shots."""
    return expand("results/shots/{shot}/expression.parquet", shot=basis_shots(wildcards))


def basis_film_paths(wildcards):
    """Return the films of an actor's basis shots."""
    return [row["video"] for row in shots_of(wildcards.actor, basis=["yes"])]


def basis_films(wildcards):
    """Return the films of an actor's basis shots that exist."""
    return present(basis_film_paths(wildcards))


def basis_tracked(wildcards):
    """Return the tracked points of an actor's basis shots."""
    return expand("results/shots/{shot}/tracked.parquet", shot=basis_shots(wildcards))


def lock_rows(wildcards):
    """Return an actor's rows of key_shapes.tsv: only they change the actor's key shapes."""
    rows = rows_of(SHOW["key_shapes"], "actor", wildcards.actor)
    return ["{region}:{shot}:{frame}:{state}".format(**row) for row in rows]


def played_characters(wildcards):
    """Return the names of the characters that an actor plays."""
    return [row["character"] for row in rows_of(SHOW["cast"], "actor", wildcards.actor)]


def sculpt_states(wildcards):
    """Return the states of the sculpts of all characters that an actor plays."""
    return expand(
        "results/cast/{actor}/{character}/sculpts.parquet",
        actor=wildcards.actor,
        character=played_characters(wildcards),
    )


def key_shapes_of_shot(wildcards):
    """Return the key shapes of the shot's actor."""
    return f"results/actors/{session_of(wildcards.shot)['actor']}/key_shapes.parquet"


def character_cell(column):
    """Return a function that gives a cell of the character's row."""

    def cell(wildcards):
        return row_of(SHOW["characters"], "character", wildcards.character)[column]

    return cell


def character_path(column):
    """Return a function that gives the path of a file in the character's folder."""

    def path(wildcards):
        row = row_of(SHOW["characters"], "character", wildcards.character)
        return str(Path(row["folder"], row[column]))

    return path


def character_source(column):
    """Return a function that gives a file of the character's folder if it exists."""

    def source(wildcards):
        return present([character_path(column)(wildcards)])

    return source


def sculpt_folder(wildcards):
    """Return the folder of a character's sculpts."""
    row = row_of(SHOW["characters"], "character", wildcards.character)
    return str(Path(row["folder"], "sculpts"))


def sculpts(wildcards):
    """Return the sculpts of a character, sorted: editing, adding or removing one is noticed."""
    return sculpts_of(wildcards.character)


def rig_of(wildcards):
    """Return the rig of a take's actor and character."""
    actor = session_of(wildcards.shot)["actor"]
    return f"results/cast/{actor}/{wildcards.character}/rig.npz"


def takes():
    """Return what shows that a take is done."""
    return [f"results/takes/{shot}/{character}/preview.mp4" for shot, character in cast_takes()]


def report_command():
    """Return the command that writes the run's report from what exists."""
    shots = []
    for row in SHOW["shots"]:
        session = session_of(row.cells["shot"])
        shots.append(f"{session['actor']}/{session['session']}/{row.cells['shot']}")
    basis = [row["shot"] for row in rows_of(SHOW["shots"], "basis", "yes")]
    played = [f"{shot}/{character}" for shot, character in cast_takes()]
    return shlex.join(
        ["python", "-m", "stages.write_report", "--results", "results", "--logs", "logs"]
        + ["--shots", *shots, "--basis", *basis, "--takes", *played]
        + ["--template", template("report.html"), "--report", "results/report/index.html"]
    )
