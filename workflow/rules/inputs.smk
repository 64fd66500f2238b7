"""What the rules are given, by wildcards and tables: targets, inputs and params. No rules."""


def tracked_shots(session):
    """Return the names of a session's shots whose films are tracked."""
    shots = rows_of(SHOW["shots"], "session", session)
    return [shot["shot"] for shot in shots if has_points(SHOW, shot, "video")]


def label_proposals():
    """Return the proposals of every session whose films are tracked."""
    sessions = [name for name in cells(SHOW["sessions"], "session") if tracked_shots(name)]
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


def shot_cell(column):
    """Return a function that gives a cell of the shot's row."""

    def cell(wildcards):
        return row_of(SHOW["shots"], "shot", wildcards.shot)[column]

    return cell


def shot_source(column):
    """Return a function that gives the file which a cell of the shot's row names, if it exists."""

    def source(wildcards):
        return present([shot_cell(column)(wildcards)])

    return source


def tracked_of(wildcards):
    """Return the tracked points of a shot, if its film is tracked."""
    shot = row_of(SHOW["shots"], "shot", wildcards.shot)
    wanted = has_points(SHOW, shot, "video")
    return [f"results/shots/{shot['shot']}/tracked.parquet"] if wanted else []


def markers_of(wildcards):
    """Return the imported markers of a shot, if it has any."""
    wanted = shot_cell("markers")(wildcards)
    return [f"results/shots/{wildcards.shot}/markers.parquet"] if wanted else []


def sync_of(wildcards):
    """Return how the markers' clock and the film's go together, where a shot has both."""
    both = all(shot_cell(column)(wildcards) for column in ("markers", "video"))
    return [f"results/shots/{wildcards.shot}/sync.json"] if both else []


def merged_film(wildcards):
    """Return the film whose length a shot with markers takes."""
    shot = row_of(SHOW["shots"], "shot", wildcards.shot)
    return [shot["video"]] if shot["markers"] and shot["video"] else []


def merged_film_source(wildcards):
    """Return that film if it exists."""
    return present(merged_film(wildcards))


def sound_of(wildcards):
    """Return the sound in which a shot's phones are found: the marker system's, else the film's."""
    return shot_cell("sound")(wildcards) or shot_cell("video")(wildcards)


def sound_sync_of(wildcards):
    """Return what brings that sound's times to the film's clock, where that is needed."""
    return sync_of(wildcards) if shot_cell("sound")(wildcards) else []


def session_shots(wildcards):
    """Return the names of a session's tracked shots."""
    return tracked_shots(wildcards.session)


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
    """Return the brief of every actor who has filmed basis shots and is not for rigs alone."""
    actors = []
    for actor in sorted(set(cells(SHOW["sessions"], "actor"))):
        played = rows_of(SHOW["cast"], "actor", actor)
        methods = [character_row(row["character"])["method"] for row in played]
        if shots_of(actor, "video", ["yes"]) and ("key_shapes" in methods or not methods):
            actors.append(actor)
    return expand("results/actors/{actor}/brief/index.html", actor=actors)


def basis_shots(wildcards):
    """Return the names of an actor's basis shots."""
    return [row["shot"] for row in shots_of(wildcards.actor, "video", ["yes"])]


def basis_expressions(wildcards):
    """Return the expressions of an actor's basis shots."""
    return expand("results/shots/{shot}/expression.parquet", shot=basis_shots(wildcards))


def basis_film_paths(wildcards):
    """Return the films of an actor's basis shots."""
    return [row["video"] for row in shots_of(wildcards.actor, "video", ["yes"])]


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


def sculpts(wildcards):
    """Return the sculpts of a character, sorted: editing, adding or removing one is noticed."""
    suffix = Path(character_row(wildcards.character)["neutral"]).suffix
    return files_of(wildcards.character, f"sculpts/*/*{suffix}")


def rig_shapes(wildcards):
    """Return the shapes of a character's rig, sorted."""
    suffix = Path(character_row(wildcards.character)["neutral"]).suffix
    return files_of(wildcards.character, f"shapes/*{suffix}")


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


def regression_of(wildcards):
    """Return the trained regression of a take's actor and character."""
    actor = session_of(wildcards.shot)["actor"]
    return f"results/cast/{actor}/{wildcards.character}/rbf.npz"


def solution_of(wildcards):
    """Return the weights that a take's method finds, before smoothing."""
    method = character_row(wildcards.character)["method"]
    take = f"results/takes/{wildcards.shot}/{wildcards.character}"
    return {
        "key_shapes": f"results/shots/{wildcards.shot}/key_weights.parquet",
        "rbf": f"{take}/predicted.parquet",
        "blendshapes": f"{take}/solved.parquet",
    }[method]


def rig_of(wildcards):
    """Return the rig of a take's actor and character."""
    actor = session_of(wildcards.shot)["actor"]
    return f"results/cast/{actor}/{wildcards.character}/rig.npz"


def shown_tracked(wildcards):
    """Return the tracked points of a take that the film's points drive."""
    return tracked_of(wildcards) if points_of(wildcards) == "video" else []


def shown_performance(wildcards):
    """Return the performance of a take that markers drive."""
    path = f"results/shots/{wildcards.shot}/performance.parquet"
    return [path] if points_of(wildcards) == "markers" else []


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
