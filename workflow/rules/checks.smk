"""What the tables of a show must say together, beyond what each says alone; no rules."""

# what may drive the characters of each method
POINTS = {
    "key_shapes": ["video"],
    "layers": ["video", "markers", "both"],
    "rbf": ["video", "markers", "curves"],
    "blendshapes": ["video", "markers", "curves"],
}


def has_points(tables, shot, points):
    """Return whether a shot has markers, or film points that are tracked.

    A film beside markers is tracked only where its session has labels: else it is for people.
    """
    if points == "both":
        return all(has_points(tables, shot, kind) for kind in ("video", "markers"))
    if points in ("markers", "curves"):
        return bool(shot[points])
    if shot["landmarks"] or not shot["video"]:
        return bool(shot["landmarks"])
    same = (row.cells for row in tables["shots"] if row.cells["session"] == shot["session"])
    return not shot["markers"] or any(row["labels"] for row in same)


def refuse(name, row, column, message):
    """Stop with the place of a cell."""
    raise errors.InputError(f"config/{name}.tsv", f"line {row.line}, column {column}: {message}")


def check_references(tables, face_regions):
    """Refuse references to nothing, with table, row and column."""
    shots = cells(tables["shots"], "shot")
    basis = [row["shot"] for row in rows_of(tables["shots"], "basis", "yes")]
    known = {
        "session": (cells(tables["sessions"], "session"), "sessions.tsv"),
        "actor": (cells(tables["sessions"], "actor"), "sessions.tsv"),
        "shots": (shots, "shots.tsv"),
        "neutral_shot": (basis, "shots.tsv with basis yes"),
        "shot": (basis, "shots.tsv with basis yes"),
        "region": (list(face_regions), "regions.tsv"),
        "character": (cells(tables["characters"], "character"), "characters.tsv"),
    }
    for name, columns in TABLES.items():
        for column in columns:
            names, where = known[column]
            show.check_references(f"config/{name}.tsv", tables[name], column, names, where)


def check_expression(tables, row):
    """Refuse an extreme that is seen in another actor's shot."""
    session = row_of(tables["shots"], "shot", row.cells["shot"])["session"]
    whose = row_of(tables["sessions"], "session", session)["actor"]
    if whose != row.cells["actor"]:
        message = f"'{row.cells['shot']}' shows {whose}; choose a shot of {row.cells['actor']}"
        refuse("expressions", row, "shot", message)


def check_directing(tables, row):
    """Refuse gains of takes that do not exist or have no layers."""
    shots = cells(tables["shots"], "shot")
    show.check_references("config/directing.tsv", [row], "shot", shots, "shots.tsv")
    if row_of(tables["characters"], "character", row.cells["character"])["method"] != "layers":
        message = f"'{row.cells['character']}' is not driven by layers; only they can be directed"
        refuse("directing", row, "character", message)


def check_extremes(tables):
    """Refuse names that no extreme has, frames with two, and gains and times that mean nothing."""
    known = extremes.read(data_table("extremes.tsv"))
    for actor in dict.fromkeys(cells(tables["expressions"], "actor")):
        shots = [row["shot"] for row in rows_of(tables["expressions"], "actor", actor)]
        expressions.read("config/expressions.tsv", actor, shots, known)
    if tables["directing"]:
        directing_table.read("config/directing.tsv", known, "", "")


def check_sense(tables, face_regions):
    """Refuse rows that ask for what other cells do not give."""
    if not face_regions and any(
        row.cells["method"] == "key_shapes" for row in tables["characters"]
    ):
        message = "names no region, yet a character is driven by key shapes: add rows"
        raise errors.InputError("config/regions.tsv", message)
    for row in tables["shots"]:
        check_shot(row)
        check_cut(row)
    for row in tables["sessions"]:
        check_session(tables, row)
    for row in tables["characters"]:
        check_character(row)
    for row in tables["cast"]:
        check_cast(tables, row)
    for row in tables["expressions"]:
        check_expression(tables, row)
    for row in tables["directing"]:
        check_directing(tables, row)
    check_extremes(tables)


def check_cut(row):
    """Refuse a cut that ends before it begins, or handles of no cut."""
    first, last = row.cells["first_frame"], row.cells["last_frame"]
    if first and last and int(last) < int(first):
        refuse("shots", row, "last_frame", f"{last} comes before first_frame {first}; correct one")
    if row.cells["handles"] and not (first or last):
        refuse("shots", row, "handles", "is of no use without first_frame or last_frame; clear it")


def check_shot(row):
    """Refuse a shot without points, or with cells that need others."""
    shot = row.cells
    if not any(shot[column] for column in ("video", "markers", "landmarks", "curves")):
        refuse(
            "shots", row, "video", "the shot has no film, markers, landmarks or curves; give one"
        )
    for column, needed in (("labels", "video"), ("sync_offset_s", "markers")):
        if shot[column] and not shot[needed]:
            refuse("shots", row, column, f"is of no use without {needed}; clear it")
    for column in ("transcript", "words"):
        if shot[column] and not (shot["video"] or shot["sound"]):
            refuse("shots", row, column, "has no sound to be found in; give sound or video")
    if shot["sound"] and shot["video"] and not shot["markers"]:
        message = "is the marker system's, yet the film has no markers beside it; clear the cell"
        refuse("shots", row, "sound", message)
    if shot["markers"] and shot["video"] and not (shot["sound"] or shot["sync_offset_s"]):
        message = (
            "film and markers share no clock; give the marker system's sound, or sync_offset_s"
        )
        refuse("shots", row, "sound", message)


def check_session(tables, row):
    """Refuse a session whose neutral does not show all the points of its shots."""
    session = row.cells
    shots = [
        other.cells for other in tables["shots"] if other.cells["session"] == session["session"]
    ]
    neutral = row_of(tables["shots"], "shot", session["neutral_shot"])
    whose = row_of(tables["sessions"], "session", neutral["session"])["actor"]
    if whose != session["actor"]:
        message = f"'{neutral['shot']}' shows {whose}, not {session['actor']}"
        refuse("sessions", row, "neutral_shot", f"{message}; choose a shot of the same actor")
    for points in ("video", "markers"):
        if any(has_points(tables, shot, points) for shot in shots):
            if not has_points(tables, neutral, points):
                message = f"'{neutral['shot']}' has no {points} points, other shots of it have"
                refuse("sessions", row, "neutral_shot", f"{message}; choose one with both")
    if any(shot["markers"] for shot in shots) and not session["unit_markers"]:
        message = "is blank, yet its shots have markers; name two, such as those at the eye corners"
        refuse("sessions", row, "unit_markers", message)


def check_character(row):
    """Refuse a character without the file that its method needs."""
    own_shapes = row.cells["method"] in ("key_shapes", "layers")
    named = not own_shapes or row.cells["delivery_shapes"]
    if not named and "livelink" in show.listed(row.cells["outputs"]):
        refuse(
            "characters",
            row,
            "outputs",
            "livelink needs named shapes; remove it, or give delivery_shapes",
        )
    if own_shapes and row.cells["neutral"].endswith(".glb"):
        refuse("characters", row, "neutral", "this method needs an .obj, .ply or .csv; export one")
    if row.cells["method"] == "layers" and row.cells["masks"].endswith(".ply"):
        if len(show.listed(row.cells["painted_masks"])) != 3:
            message = "masks are painted; name those that are red, green and blue, with commas"
            refuse("characters", row, "painted_masks", message)
    if row.cells["method"] == "layers" and row.cells["channels"]:
        if not row.cells["delivery_shapes"]:
            message = "method layers has channels of its delivery_shapes alone; clear the cell"
            refuse("characters", row, "channels", message)
    if float(row.cells["damping"]) == 0:
        refuse("characters", row, "damping", "must be above 0; write 1 for critical damping")
    if float(row.cells["face_unit"]) == 0:
        refuse("characters", row, "face_unit", "must be above 0; measure between the eyes")
    tempo_text.read(f"config/characters.tsv: line {row.line}, column tempo", row.cells["tempo"])
    if row.cells["delivery_shapes"] and row.cells["neutral"].endswith(".csv"):
        refuse("characters", row, "delivery_shapes", "controls have no blendshapes; clear the cell")
    if row.cells["outputs"] and row.cells["neutral"].endswith(".csv"):
        refuse("characters", row, "outputs", "a table of controls has no mesh; clear the cell")
    if own_shapes and not row.cells["masks"]:
        message = f"method {row.cells['method']} needs it; name the file"
        refuse("characters", row, "masks", message)


def check_cast(tables, row):
    """Refuse a take whose points do not exist, or do not fit the character's method."""
    character = row_of(tables["characters"], "character", row.cells["character"])
    method = character["method"]
    points, wanted = row.cells["points"], show.listed(row.cells["shots"])
    fitting = POINTS[method]
    if points not in fitting:
        message = f"method {method} is driven by {' or '.join(fitting)}; write that"
        refuse("cast", row, "points", message)
    if method == "blendshapes" and points != "curves" and not character["virtual_markers"]:
        message = "method blendshapes needs virtual_markers in characters.tsv; name the file"
        refuse("cast", row, "character", message)
    sessions = [
        other.cells["session"]
        for other in tables["sessions"]
        if other.cells["actor"] == row.cells["actor"]
    ]
    shots = [other.cells for other in tables["shots"] if other.cells["session"] in sessions]
    driven = [shot["shot"] for shot in shots if has_points(tables, shot, points)]
    for name in wanted or ([] if driven else ["any shot of this actor"]):
        if name not in driven:
            refuse("cast", row, "points", f"{name} has no {points} points; correct the cell")
