"""From films and labels to tracked points on a constant clock.

Needs a session's films and labels. Makes tracker.npz, label_proposals.tsv, and for each shot
tracked.parquet (at the film's own times) and performance.parquet (at a constant rate).
"""


def labelled_shots(session):
    """Return the rows of a session's shots that have labels."""
    return [row for row in rows_of(SHOW["shots"], "session", session) if row["labels"]]


def label_proposals():
    """Return the proposals of every session."""
    return expand(
        "results/sessions/{session}/label_proposals.tsv", session=cells(SHOW["sessions"], "session")
    )


def training_sources(wildcards):
    """Return the films and label tables of a session that exist."""
    rows = labelled_shots(wildcards.session)
    return present([row[column] for row in rows for column in ("video", "labels")])


def film_of(wildcards):
    """Return the film of a shot if it exists."""
    return present([row_of(SHOW["shots"], "shot", wildcards.shot)["video"]])


def tracked_of_session(wildcards):
    """Return the tracked points of all shots of a session."""
    shots = [row["shot"] for row in rows_of(SHOW["shots"], "session", wildcards.session)]
    return expand("results/shots/{shot}/tracked.parquet", shot=shots)


rule train_tracker:
    input:
        training_sources,
        point_set="config/point_set.tsv",
    output:
        tracker="results/sessions/{session}/tracker.npz",
    params:
        code=code_of("train_tracker"),
        shots=lambda w: [row["shot"] for row in labelled_shots(w.session)],
        videos=lambda w: [row["video"] for row in labelled_shots(w.session)],
        labels=lambda w: [row["labels"] for row in labelled_shots(w.session)],
        method=config["tracker_method"],
        seed=config["seed"],
    log:
        "logs/train_tracker/{session}.log",
    benchmark:
        "logs/train_tracker/{session}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    shell:
        "python -m stages.train_tracker"
        " --shots {params.shots:q}"
        " --videos {params.videos:q}"
        " --labels {params.labels:q}"
        " --point-set {input.point_set:q}"
        " --method {params.method:q}"
        " --seed {params.seed}"
        " --tracker {output.tracker:q}"
        " 2> {log:q}"
