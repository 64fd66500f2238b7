"""What the rules of takes are given, by wildcards and tables. No rules."""


def solution_path(shot, character, points):
    """Return the weights that a take's method finds, before all that follows."""
    method = character_row(character)["method"]
    take = f"results/takes/{shot}/{character}"
    if points == "curves":
        return f"{take}/mapped.parquet"
    return {
        "key_shapes": f"results/shots/{shot}/key_weights.parquet",
        "layers": f"{take}/directed.parquet",
        "rbf": f"{take}/predicted.parquet",
        "blendshapes": f"{take}/solved.parquet",
    }[method]


def solution_of(wildcards):
    """Return the weights that a take's method finds, before smoothing."""
    return solution_path(wildcards.shot, wildcards.character, points_of(wildcards))


# a take is shaped after its character's nature where one of these is not as here
NATURE = {"head_gain": "1 1 1", "head_limit": "", "head_axes": "x y z", "follow_s": "0"}


def has_nature(row):
    """Return whether a character asks for motion unlike the actor's."""
    return any(row[column] != usual for column, usual in NATURE.items())


def smoothed_solution(wildcards):
    """Return the weights that are smoothed: as solved, or after the character's nature."""
    if has_nature(character_row(wildcards.character)):
        return f"results/takes/{wildcards.shot}/{wildcards.character}/shaped.parquet"
    return solution_of(wildcards)


def smoothed_head_motion(wildcards):
    """Return the head motion that goes with them."""
    if has_nature(character_row(wildcards.character)):
        return f"results/takes/{wildcards.shot}/{wildcards.character}/shaped_head.parquet"
    return head_motion_of(wildcards)


def basis_solutions(wildcards):
    """Return these of an actor's basis shots, from which a character's dynamics are learnt."""
    points, character = points_of(wildcards), wildcards.character
    rows = shots_of(wildcards.actor, points, ["yes"])
    return [solution_path(row["shot"], character, points) for row in rows]


def dynamics_of(wildcards):
    """Return how a character moves, where gaps are filled or curves smoothed by that."""
    row, actor = character_row(wildcards.character), session_of(wildcards.shot)["actor"]
    asked = "dynamics" in (row["gap_filling"], row["smoothing"])
    return [f"results/cast/{actor}/{wildcards.character}/dynamics.npz"] if asked else []


def rig_of(wildcards):
    """Return the rig of a take's actor and character."""
    actor = session_of(wildcards.shot)["actor"]
    return f"results/cast/{actor}/{wildcards.character}/rig.npz"


def head_motion_of(wildcards):
    """Return the head motion of a take, from its points or recorded with its curves."""
    name = "curve_head_motion" if points_of(wildcards) == "curves" else "head_motion"
    return f"results/shots/{wildcards.shot}/{name}.parquet"


def expression_of(wildcards):
    """Return the expression of a take that points drive."""
    path = f"results/shots/{wildcards.shot}/expression.parquet"
    return [] if points_of(wildcards) == "curves" else [path]


def cut_film(wildcards):
    """Return the film in whose frames a shot's cut and timecode are counted, if they are."""
    shot = row_of(SHOW["shots"], "shot", wildcards.shot)
    counted = any(shot[column] for column in ("first_frame", "last_frame", "start_timecode"))
    return [shot["video"]] if counted and shot["video"] else []


def cut_film_source(wildcards):
    """Return that film if it exists."""
    return present(cut_film(wildcards))


def edits_of(wildcards):
    """Return an animator's edited curves of a take, sorted: a later one has the last word."""
    folder = f"edits/{wildcards.shot}"
    tables = [files_of(wildcards.character, f"{folder}/*.{kind}") for kind in ("tsv", "csv")]
    return sorted(sum(tables, []))


def lip_points_of(wildcards):
    """Return the points that show lip closures in a take that points drive."""
    return session_cell("lip_points")(wildcards) if expression_of(wildcards) else ""


def shown_curves(wildcards):
    """Return the recorded curves of a take that they drive."""
    path = f"results/shots/{wildcards.shot}/curves.parquet"
    return [path] if points_of(wildcards) == "curves" else []


def shown_tracked(wildcards):
    """Return the tracked points of a take that the film's points drive."""
    return tracked_of(wildcards) if points_of(wildcards) in ("video", "both") else []


def shown_performance(wildcards):
    """Return the performance of a take that markers drive."""
    path = f"results/shots/{wildcards.shot}/performance.parquet"
    return [path] if points_of(wildcards) in ("markers", "both") else []


def take_sound(wildcards):
    """Return the film or sound of a shot that goes with a take."""
    return sound_path(wildcards.shot)


def sound_path(shot):
    """Return the film of a shot, or the sound that was recorded without one, or a blank."""
    row = row_of(SHOW["shots"], "shot", shot)
    return row["video"] or row["sound"]


def take_sound_source(wildcards):
    """Return that file if it exists."""
    return present([take_sound(wildcards)])


def retimed_sound(shot, character):
    """Return the sound of a take at another tempo than the actor's, where it has one."""
    asked = tempo_text.read("tempo", character_row(character)["tempo"]) != 1 and sound_path(shot)
    return [f"results/takes/{shot}/{character}/sound.flac"] if asked else []
