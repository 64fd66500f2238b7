"""What the rules of shots, sessions and actors are given, by wildcards and tables. No rules."""


def tracked_shots(session):
    """Return the names of a session's shots whose films are tracked here."""
    shots = rows_of(SHOW["shots"], "session", session)
    return [
        shot["shot"] for shot in shots if has_points(SHOW, shot, "video") and not shot["landmarks"]
    ]


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


def shot_files(column):
    """Return a function that gives the file which a cell of the shot's row names, or no file."""

    def files(wildcards):
        path = shot_cell(column)(wildcards)
        return [path] if path else []

    return files


def tracked_of(wildcards):
    """Return the film points of a shot, tracked here or elsewhere, if it has any."""
    shot = row_of(SHOW["shots"], "shot", wildcards.shot)
    return [tracked_path(shot)] if has_points(SHOW, shot, "video") else []


def tracked_path(shot):
    """Return the points of a shot's film, tracked here or elsewhere."""
    name = "imported" if shot["landmarks"] else "tracked"
    return f"results/shots/{shot['shot']}/{name}.parquet"


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
    shot = row_of(SHOW["shots"], "shot", wildcards.shot)
    path = shot["sound"] or shot["video"]
    return [path] if path else []


def sound_source(wildcards):
    """Return that sound if it exists."""
    return present(sound_of(wildcards))


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


def session_source(column):
    """Return a function that gives the file which a cell of the shot's session names, if any."""

    def source(wildcards):
        return present([session_of(wildcards.shot)[column]])

    return source


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


def reference_pages():
    """Return the reference frames of everyone who is driven by tuned pairs."""
    pages = []
    for row in (row.cells for row in SHOW["cast"]):
        if character_row(row["character"])["method"] == "rbf" and row["points"] != "curves":
            folder = f"results/cast/{row['actor']}/{row['character']}/references"
            pages.append(f"{folder}/index.html")
            if any(shot["curves"] for shot in shots_of(row["actor"], row["points"], ["yes"])):
                pages.append(f"{folder}/curve_pairs.tsv")
    return pages


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
    """Return the film points of an actor's basis shots."""
    return [tracked_path(shot) for shot in shots_of(wildcards.actor, "video", ["yes"])]


def lock_rows(wildcards):
    """Return an actor's rows of key_shapes.tsv: only they change the actor's key shapes."""
    rows = rows_of(SHOW["key_shapes"], "actor", wildcards.actor)
    return ["{region}:{shot}:{frame}:{state}".format(**row) for row in rows]


def played_characters(wildcards):
    """Return the names of the characters that an actor plays by sculpts."""
    played = [row["character"] for row in rows_of(SHOW["cast"], "actor", wildcards.actor)]
    return [name for name in played if character_row(name)["method"] == "key_shapes"]


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
