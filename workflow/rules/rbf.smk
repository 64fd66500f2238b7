"""From tuned pairs, or from the rig alone, to the weights of an existing blendshape rig.

Needs expression.parquet of the shots and the character's folder. Makes rig.npz of each actor and
character, and predicted.parquet or solved.parquet of each take.
"""


rule assemble_blendshapes:
    input:
        character_source("neutral"),
        shapes=rig_shapes,
    output:
        rig="results/cast/{actor}/{character}/rig.npz",
    log:
        "logs/assemble_blendshapes/{actor}/{character}.log",
    benchmark:
        "logs/assemble_blendshapes/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("rbf", "blendshapes"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("assemble_blendshapes"),
        neutral=character_path("neutral"),
        shape_folder=folder_of("shapes"),
        unit=character_cell("unit"),
        up_axis=character_cell("up_axis"),
        pivot=character_cell("pivot"),
        face_unit=character_cell("face_unit"),
    shell:
        "python -m stages.assemble_blendshapes"
        " --neutral {params.neutral:q}"
        " --shapes {input.shapes:q}"
        " --shape-folder {params.shape_folder:q}"
        " --unit {params.unit:q}"
        " --up-axis {params.up_axis:q}"
        " --pivot={params.pivot:q}"
        " --face-unit {params.face_unit}"
        " --rig {output.rig:q}"
        " 2> {log:q}"


rule solve_blendshapes:
    input:
        character_source("virtual_markers"),
        character_source("channels"),
        expression="results/shots/{shot}/expression.parquet",
        rig=rig_of,
    output:
        solved="results/takes/{shot}/{character}/solved.parquet",
    log:
        "logs/solve_blendshapes/{shot}/{character}.log",
    benchmark:
        "logs/solve_blendshapes/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_method("blendshapes"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("solve_blendshapes"),
        points=points_of,
        virtual_markers=character_path("virtual_markers"),
        channels=character_path("channels"),
        solve=character_cell("solve"),
        strength=character_cell("strength"),
    shell:
        "python -m stages.solve_blendshapes"
        " --expression {input.expression:q}"
        " --points {params.points:q}"
        " --rig {input.rig:q}"
        " --virtual-markers {params.virtual_markers:q}"
        " --channels {params.channels:q}"
        " --solve {params.solve:q}"
        " --strength {params.strength}"
        " --solved {output.solved:q}"
        " 2> {log:q}"
