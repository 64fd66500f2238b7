"""What a run is for: the files of every take, and the report. No rules."""

# the files that each name in the column outputs stands for
OUTPUTS = {
    "blender": ["blender.py"],
    "keys": ["keys.csv", "keys.json"],
    "livelink": ["livelink.csv"],
    "maya": ["maya.py", "maya.anim"],
    "mdd": ["mesh.mdd"],
    "obj": ["obj"],
    "openvat": ["texture/openvat/texture.exr"],
    "texture": ["texture/plain/texture.exr"],
    "usd": ["mesh.usdc", "points.usdc"],
}


# of these, those that hold the curves of named shapes
CURVES = ("blender", "keys", "livelink", "maya")


def delivers(row, name):
    """Return whether an output shows the blendshapes onto which layers are projected."""
    return row["method"] == "layers" and bool(row["delivery_shapes"]) and name in CURVES


def takes():
    """Return what shows that a take is done, and the further files that are asked for."""
    wanted = []
    for shot, character in cast_takes():
        folder = f"results/takes/{shot}/{character}"
        wanted += [f"{folder}/preview.mp4", *layer_outputs(shot, character)]
        wanted += retimed_sound(shot, character)
        row = character_row(character)
        for name in show.listed(row["outputs"]):
            place = f"{folder}/delivery" if delivers(row, name) else folder
            wanted += [f"{place}/{file}" for file in OUTPUTS[name]]
    return wanted


def rig_checks():
    """Return what looks wrong with the rigs of the cast."""
    played = [row.cells for row in SHOW["cast"]]
    rigs = [
        f"results/cast/{row['actor']}/{row['character']}"
        for row in played
        if character_row(row["character"])["method"] in ("rbf", "blendshapes")
    ]
    return [f"{folder}/rig_checks.tsv" for folder in dict.fromkeys(rigs)]


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
