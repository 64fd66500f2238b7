"""From what other trackers and phones recorded to this show's points and curves.

Needs their files. Makes imported.parquet (points, as tracked.parquet) or curves.parquet with
curve_head_motion.parquet of each shot, and mapped.parquet of each take that curves drive.
"""


rule import_landmarks:
    input:
        shot_source("landmarks"),
        shot_source("video"),
        maps=landmark_maps(),
    output:
        tracked="results/shots/{shot}/imported.parquet",
    log:
        "logs/import_landmarks/{shot}.log",
    benchmark:
        "logs/import_landmarks/{shot}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("import_landmarks"),
        landmarks=shot_cell("landmarks"),
        video=shot_files("video"),
        rate=session_cell("source_rate"),
    shell:
        "python -m stages.import_landmarks"
        " --landmarks={params.landmarks:q}"
        " --video {params.video:q}"
        " --maps {input.maps:q}"
        " --rate={params.rate:q}"
        " --tracked {output.tracked:q}"
        " 2> {log:q}"


rule import_curves:
    input:
        shot_source("curves"),
        names=data_table("shape_names.tsv"),
    output:
        curves="results/shots/{shot}/curves.parquet",
        head_motion="results/shots/{shot}/curve_head_motion.parquet",
        checks="results/shots/{shot}/curve_checks.tsv",
    log:
        "logs/import_curves/{shot}.log",
    benchmark:
        "logs/import_curves/{shot}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("import_curves"),
        curve_file=shot_cell("curves"),
        rate=session_cell("source_rate"),
    shell:
        "python -m stages.import_curves"
        " --curve-file={params.curve_file:q}"
        " --names {input.names:q}"
        " --rate={params.rate:q}"
        " --curves {output.curves:q}"
        " --head-motion {output.head_motion:q}"
        " --checks {output.checks:q}"
        " 2> {log:q}"


rule map_curves:
    input:
        curves="results/shots/{shot}/curves.parquet",
        rig=rig_of,
        names=data_table("shape_names.tsv"),
    output:
        mapped="results/takes/{shot}/{character}/mapped.parquet",
    log:
        "logs/map_curves/{shot}/{character}.log",
    benchmark:
        "logs/map_curves/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_method("rbf", "blendshapes"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("map_curves"),
    shell:
        "python -m stages.map_curves"
        " --curves {input.curves:q}"
        " --rig {input.rig:q}"
        " --names {input.names:q}"
        " --mapped {output.mapped:q}"
        " 2> {log:q}"


rule write_pairs:
    input:
        character_source("channels"),
        mapped=mapped_pair_shots,
        references="results/cast/{actor}/{character}/references.parquet",
    output:
        pairs="results/cast/{actor}/{character}/references/curve_pairs.tsv",
    log:
        "logs/write_pairs/{actor}/{character}.log",
    benchmark:
        "logs/write_pairs/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("rbf"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("write_pairs"),
        shots=curve_pair_shots,
        channels=character_path("channels"),
    shell:
        "python -m stages.write_pairs"
        " --mapped {input.mapped:q}"
        " --shots {params.shots:q}"
        " --references {input.references:q}"
        " --channels={params.channels:q}"
        " --pairs {output.pairs:q}"
        " 2> {log:q}"
