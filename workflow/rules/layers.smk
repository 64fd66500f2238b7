"""From an actor's extremes and a character's poses to the layers of a take.

Needs expression.parquet of the shots, expressions.tsv and the character's folder. Makes rig.npz,
poses.parquet and simplices.npz of each actor and character, layers.parquet and directed.parquet of
each take, the curves of each layer, and for each actor proposals of extremes.
"""


rule assemble_poses:
    input:
        character_source("neutral"),
        character_source("masks"),
        poses=poses,
        shapes=blendshapes_of_poses,
        extremes=data_table("extremes.tsv"),
    output:
        rig="results/cast/{actor}/{character}/rig.npz",
        poses_table="results/cast/{actor}/{character}/poses.parquet",
    log:
        "logs/assemble_poses/{actor}/{character}.log",
    benchmark:
        "logs/assemble_poses/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("layers"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("assemble_poses"),
        neutral=character_path("neutral"),
        pose_folder=folder_of("poses"),
        masks=character_path("masks"),
        painted_masks=character_cell("painted_masks"),
        unit=character_cell("unit"),
        up_axis=character_cell("up_axis"),
        pivot=character_cell("pivot"),
        face_unit=character_cell("face_unit"),
    shell:
        "python -m stages.assemble_poses"
        " --neutral {params.neutral:q}"
        " --poses {input.poses:q}"
        " --pose-folder {params.pose_folder:q}"
        " --shapes {input.shapes:q}"
        " --masks {params.masks:q}"
        " --painted-masks={params.painted_masks:q}"
        " --extremes {input.extremes:q}"
        " --unit {params.unit:q}"
        " --up-axis {params.up_axis:q}"
        " --pivot={params.pivot:q}"
        " --face-unit {params.face_unit}"
        " --rig {output.rig:q}"
        " --poses-table {output.poses_table:q}"
        " 2> {log:q}"


rule assemble_simplices:
    input:
        ancient(layer_tables),
        expressions=layer_expressions,
        poses="results/cast/{actor}/{character}/poses.parquet",
        rig="results/cast/{actor}/{character}/rig.npz",
        extremes=data_table("extremes.tsv"),
    output:
        simplices="results/cast/{actor}/{character}/simplices.npz",
        report="results/cast/{actor}/{character}/simplices.tsv",
    log:
        "logs/assemble_simplices/{actor}/{character}.log",
    benchmark:
        "logs/assemble_simplices/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("layers"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("assemble_simplices"),
        expression_table="config/expressions.tsv",
        mask_table="config/actor_masks.tsv",
        shots=layer_shots,
        points=points_of,
        rows=expression_rows,
        mask_rows=actor_mask_rows,
        balance=character_cell("balance"),
        lip_points=lip_points_of_actor,
        lip_mask=character_cell("lip_mask"),
        lip_sigma=character_cell("lip_sigma"),
    shell:
        "python -m stages.assemble_simplices"
        " --actor {wildcards.actor:q}"
        " --expression-table {params.expression_table:q}"
        " --mask-table {params.mask_table:q}"
        " --shots {params.shots:q}"
        " --expressions {input.expressions:q}"
        " --points {params.points:q}"
        " --poses {input.poses:q}"
        " --rig {input.rig:q}"
        " --extremes {input.extremes:q}"
        " --balance {params.balance:q}"
        " --lip-points={params.lip_points:q}"
        " --lip-mask {params.lip_mask:q}"
        " --lip-sigma {params.lip_sigma}"
        " --simplices {output.simplices:q}"
        " --report {output.report:q}"
        " 2> {log:q}"


rule transfer_layers:
    input:
        simplices=simplices_of,
        expression="results/shots/{shot}/expression.parquet",
    output:
        layers="results/takes/{shot}/{character}/layers.parquet",
    log:
        "logs/transfer_layers/{shot}/{character}.log",
    benchmark:
        "logs/transfer_layers/{shot}/{character}.tsv"
    wildcard_constraints:
        character=layer_characters("solver", "certified"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("transfer_layers"),
        lip_points=session_cell("lip_points"),
        lip_mask=character_cell("lip_mask"),
        lip_sigma=character_cell("lip_sigma"),
        lip_bias=character_cell("lip_bias"),
        temporal=character_cell("temporal"),
        beyond=character_cell("beyond"),
        lean=character_cell("lean"),
    shell:
        "python -m stages.transfer_layers"
        " --simplices {input.simplices:q}"
        " --expression {input.expression:q}"
        " --lip-points={params.lip_points:q}"
        " --lip-mask {params.lip_mask:q}"
        " --lip-sigma {params.lip_sigma}"
        " --lip-bias {params.lip_bias:q}"
        " --temporal {params.temporal}"
        " --beyond {params.beyond}"
        " --lean {params.lean}"
        " --layers {output.layers:q}"
        " 2> {log:q}"


rule transfer_layers_published:
    input:
        simplices=simplices_of,
        expression="results/shots/{shot}/expression.parquet",
    output:
        layers="results/takes/{shot}/{character}/layers.parquet",
    log:
        "logs/transfer_layers_published/{shot}/{character}.log",
    benchmark:
        "logs/transfer_layers_published/{shot}/{character}.tsv"
    wildcard_constraints:
        character=layer_characters("solver", "published"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("transfer_layers_published"),
        lip_points=session_cell("lip_points"),
        lip_mask=character_cell("lip_mask"),
        lip_sigma=character_cell("lip_sigma"),
        lip_bias=character_cell("lip_bias"),
        temporal=character_cell("temporal"),
        beyond=character_cell("beyond"),
        lean=character_cell("lean"),
        seed=config["seed"],
    shell:
        "python -m stages.transfer_layers_published"
        " --simplices {input.simplices:q}"
        " --expression {input.expression:q}"
        " --lip-points={params.lip_points:q}"
        " --lip-mask {params.lip_mask:q}"
        " --lip-sigma {params.lip_sigma}"
        " --lip-bias {params.lip_bias:q}"
        " --temporal {params.temporal}"
        " --beyond {params.beyond}"
        " --lean {params.lean}"
        " --seed {params.seed}"
        " --layers {output.layers:q}"
        " 2> {log:q}"


rule direct_layers:
    input:
        ancient(directing_source),
        layers="results/takes/{shot}/{character}/layers.parquet",
        rig=rig_of,
        extremes=data_table("extremes.tsv"),
    output:
        directed="results/takes/{shot}/{character}/directed.parquet",
    log:
        "logs/direct_layers/{shot}/{character}.log",
    benchmark:
        "logs/direct_layers/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_method("layers"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("direct_layers"),
        rows=directing_rows,
        directing=directing_path,
    shell:
        "python -m stages.direct_layers"
        " --layers {input.layers:q}"
        " --rig {input.rig:q}"
        " --directing={params.directing:q}"
        " --character {wildcards.character:q}"
        " --shot {wildcards.shot:q}"
        " --extremes {input.extremes:q}"
        " --directed {output.directed:q}"
        " 2> {log:q}"


rule export_layers:
    input:
        rig=rig_of,
        weights="results/takes/{shot}/{character}/weights.parquet",
    output:
        emotion="results/takes/{shot}/{character}/layers/emotion.csv",
        speech="results/takes/{shot}/{character}/layers/speech.csv",
        blink="results/takes/{shot}/{character}/layers/blink.csv",
    log:
        "logs/export_layers/{shot}/{character}.log",
    benchmark:
        "logs/export_layers/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_method("layers"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("export_layers"),
    shell:
        "python -m stages.export_layers"
        " --rig {input.rig:q}"
        " --weights {input.weights:q}"
        " --emotion {output.emotion:q}"
        " --speech {output.speech:q}"
        " --blink {output.blink:q}"
        " 2> {log:q}"


rule propose_expressions:
    input:
        proposal_films,
        expressions=proposal_expressions,
        phones=proposal_phones,
        visemes=data_table("visemes.tsv"),
        extremes=data_table("extremes.tsv"),
        template=template("expressions.html"),
    output:
        page=report(
            "results/actors/{actor}/expressions/index.html",
            caption="../report/expressions.rst",
            category="Expressions",
            labels={"actor": "{actor}"},
        ),
        table="results/actors/{actor}/expressions/expressions.tsv",
    log:
        "logs/propose_expressions/{actor}.log",
    benchmark:
        "logs/propose_expressions/{actor}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("propose_expressions"),
        shots=proposal_shots,
        emotions=proposal_cells("expression"),
        phone_shots=proposal_phone_shots,
        points=proposal_points,
        lid_points=lid_points_of_actor,
        videos=proposal_cells("video"),
        min_confidence=config["min_confidence"],
    shell:
        "python -m stages.propose_expressions"
        " --actor {wildcards.actor:q}"
        " --shots {params.shots:q}"
        " --expressions {input.expressions:q}"
        " --emotions {params.emotions:q}"
        " --phone-shots {params.phone_shots:q}"
        " --phones {input.phones:q}"
        " --visemes {input.visemes:q}"
        " --points {params.points:q}"
        " --lid-points={params.lid_points:q}"
        " --videos {params.videos:q}"
        " --extremes {input.extremes:q}"
        " --min-confidence {params.min_confidence}"
        " --template {input.template:q}"
        " --page {output.page:q}"
        " --table {output.table:q}"
        " 2> {log:q}"
