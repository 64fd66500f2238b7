"""From tuned pairs, or from the rig alone, to the weights of an existing blendshape rig.

Needs expression.parquet of the shots and the character's folder. Makes rig.npz and
rig_checks.tsv of each actor and character, and predicted.parquet or solved.parquet of each take.
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


rule check_rig:
    input:
        rig="results/cast/{actor}/{character}/rig.npz",
        names=data_table("shape_names.tsv"),
    output:
        checks="results/cast/{actor}/{character}/rig_checks.tsv",
    log:
        "logs/check_rig/{actor}/{character}.log",
    benchmark:
        "logs/check_rig/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("rbf", "blendshapes"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("check_rig"),
    shell:
        "python -m stages.check_rig"
        " --rig {input.rig:q}"
        " --names {input.names:q}"
        " --checks {output.checks:q}"
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
        character=solvable(),
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
        " --virtual-markers={params.virtual_markers:q}"
        " --channels={params.channels:q}"
        " --solve {params.solve:q}"
        " --strength {params.strength}"
        " --solved {output.solved:q}"
        " 2> {log:q}"


rule train_rbf:
    input:
        character_source("channels"),
        pairs=pair_tables,
        expressions=pair_expressions,
        rig="results/cast/{actor}/{character}/rig.npz",
    output:
        rbf="results/cast/{actor}/{character}/rbf.npz",
        residuals="results/cast/{actor}/{character}/pair_residuals.parquet",
    log:
        "logs/train_rbf/{actor}/{character}.log",
    benchmark:
        "logs/train_rbf/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("rbf"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("train_rbf"),
        shots=pair_shots,
        points=points_of,
        channels=character_path("channels"),
        regression=character_cell("regression"),
        dimensions=character_cell("dimensions"),
        widths=character_cell("widths"),
        min_confidence=config["min_confidence"],
        other_shots=other_pair_shots,
    shell:
        "python -m stages.train_rbf"
        " --pairs {input.pairs:q}"
        " --shots {params.shots:q}"
        " --expressions {input.expressions:q}"
        " --points {params.points:q}"
        " --rig {input.rig:q}"
        " --channels={params.channels:q}"
        " --regression {params.regression:q}"
        " --dimensions {params.dimensions:q}"
        " --widths {params.widths:q}"
        " --other-shots {params.other_shots:q}"
        " --min-confidence {params.min_confidence}"
        " --rbf {output.rbf:q}"
        " --residuals {output.residuals:q}"
        " 2> {log:q}"


rule predict_weights:
    input:
        character_source("channels"),
        rbf=regression_of,
        expression="results/shots/{shot}/expression.parquet",
        rig=rig_of,
    output:
        predicted="results/takes/{shot}/{character}/predicted.parquet",
    log:
        "logs/predict_weights/{shot}/{character}.log",
    benchmark:
        "logs/predict_weights/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_method("rbf"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("predict_weights"),
        points=points_of,
        channels=character_path("channels"),
    shell:
        "python -m stages.predict_weights"
        " --rbf {input.rbf:q}"
        " --expression {input.expression:q}"
        " --points {params.points:q}"
        " --rig {input.rig:q}"
        " --channels={params.channels:q}"
        " --predicted {output.predicted:q}"
        " 2> {log:q}"


rule select_references:
    input:
        character_source("channels"),
        expressions=pair_expressions,
        phones=pair_phones,
        pairs=pair_tables,
        rig="results/cast/{actor}/{character}/rig.npz",
    output:
        references="results/cast/{actor}/{character}/references.parquet",
    log:
        "logs/select_references/{actor}/{character}.log",
    benchmark:
        "logs/select_references/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("rbf"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("select_references"),
        shots=pair_shots,
        emotions=pair_cells("expression"),
        phone_shots=pair_phone_shots,
        points=points_of,
        other_shots=other_pair_shots,
        channels=character_path("channels"),
        wanted=character_cell("references"),
        min_confidence=config["min_confidence"],
    shell:
        "python -m stages.select_references"
        " --shots {params.shots:q}"
        " --expressions {input.expressions:q}"
        " --emotions {params.emotions:q}"
        " --phone-shots {params.phone_shots:q}"
        " --phones {input.phones:q}"
        " --points {params.points:q}"
        " --pairs {input.pairs:q}"
        " --other-shots {params.other_shots:q}"
        " --rig {input.rig:q}"
        " --channels={params.channels:q}"
        " --wanted {params.wanted}"
        " --min-confidence {params.min_confidence}"
        " --references {output.references:q}"
        " 2> {log:q}"


rule write_references:
    input:
        pair_films,
        references="results/cast/{actor}/{character}/references.parquet",
        expressions=pair_expressions,
        starts=pair_starts,
        rig="results/cast/{actor}/{character}/rig.npz",
        template=template("references.html"),
    output:
        page=report(
            "results/cast/{actor}/{character}/references/index.html",
            caption="../report/references.rst",
            category="References",
            labels={"actor": "{actor}", "character": "{character}"},
        ),
        table="results/cast/{actor}/{character}/references/pairs.tsv",
    log:
        "logs/write_references/{actor}/{character}.log",
    benchmark:
        "logs/write_references/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("rbf"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("write_references"),
        shots=pair_shots,
        videos=pair_cells("video"),
        points=points_of,
        pair_folder=folder_of("pairs"),
    shell:
        "python -m stages.write_references"
        " --actor {wildcards.actor:q}"
        " --character {wildcards.character:q}"
        " --references {input.references:q}"
        " --shots {params.shots:q}"
        " --expressions {input.expressions:q}"
        " --videos {params.videos:q}"
        " --points {params.points:q}"
        " --starts {input.starts:q}"
        " --rig {input.rig:q}"
        " --pair-folder {params.pair_folder:q}"
        " --template {input.template:q}"
        " --page {output.page:q}"
        " --table {output.table:q}"
        " 2> {log:q}"
