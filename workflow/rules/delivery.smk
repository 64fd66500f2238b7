"""Takes of layers as the artist's own blendshapes, where a character has them.

Needs a take's weights, and the character's folder of blendshapes. Makes delivery_rig.npz of each
actor and character, delivery.parquet and delivery.csv of each take, and their exports.
"""


use rule assemble_blendshapes as assemble_delivery with:
    input:
        character_source("neutral"),
        shapes=blendshapes_of_poses,
    output:
        rig="results/cast/{actor}/{character}/delivery_rig.npz",
    log:
        "logs/assemble_delivery/{actor}/{character}.log",
    benchmark:
        "logs/assemble_delivery/{actor}/{character}.tsv"
    wildcard_constraints:
        character=delivered_on_blendshapes(),
    params:
        code=code_of("assemble_blendshapes"),
        neutral=character_path("neutral"),
        shape_folder=delivery_folder,
        unit=character_cell("unit"),
        up_axis=character_cell("up_axis"),
        pivot=character_cell("pivot"),
        face_unit=character_cell("face_unit"),


rule project_blendshapes:
    input:
        character_source("channels"),
        rig=rig_of,
        weights="results/takes/{shot}/{character}/weights.parquet",
        delivery_rig=delivery_rig_of,
    output:
        delivery="results/takes/{shot}/{character}/delivery.parquet",
        csv="results/takes/{shot}/{character}/delivery.csv",
    log:
        "logs/project_blendshapes/{shot}/{character}.log",
    benchmark:
        "logs/project_blendshapes/{shot}/{character}.tsv"
    wildcard_constraints:
        character=delivered_on_blendshapes(),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("project_blendshapes"),
        channels=character_path("channels"),
    shell:
        "python -m stages.project_blendshapes"
        " --rig {input.rig:q}"
        " --weights {input.weights:q}"
        " --delivery-rig {input.delivery_rig:q}"
        " --channels={params.channels:q}"
        " --delivery {output.delivery:q}"
        " --csv {output.csv:q}"
        " 2> {log:q}"


use rule export_livelink as delivery_livelink with:
    input:
        rig=delivery_rig_of,
        weights="results/takes/{shot}/{character}/delivery.parquet",
        names=data_table("shape_names.tsv"),
    output:
        livelink="results/takes/{shot}/{character}/delivery/livelink.csv",
    log:
        "logs/delivery_livelink/{shot}/{character}.log",
    benchmark:
        "logs/delivery_livelink/{shot}/{character}.tsv"
    wildcard_constraints:
        character=delivered_on_blendshapes(),


use rule export_maya as delivery_maya with:
    input:
        rig=delivery_rig_of,
        weights="results/takes/{shot}/{character}/delivery.parquet",
        template=template("apply_in_maya.py"),
    output:
        script="results/takes/{shot}/{character}/delivery/maya.py",
        anim="results/takes/{shot}/{character}/delivery/maya.anim",
    log:
        "logs/delivery_maya/{shot}/{character}.log",
    benchmark:
        "logs/delivery_maya/{shot}/{character}.tsv"
    wildcard_constraints:
        character=delivered_on_blendshapes(),


use rule export_blender as delivery_blender with:
    input:
        rig=delivery_rig_of,
        weights="results/takes/{shot}/{character}/delivery.parquet",
        template=template("apply_in_blender.py"),
    output:
        script="results/takes/{shot}/{character}/delivery/blender.py",
    log:
        "logs/delivery_blender/{shot}/{character}.log",
    benchmark:
        "logs/delivery_blender/{shot}/{character}.tsv"
    wildcard_constraints:
        character=delivered_on_blendshapes(),


use rule export_curves as delivery_curves with:
    input:
        rig=delivery_rig_of,
        weights="results/takes/{shot}/{character}/delivery.parquet",
    output:
        key_table="results/takes/{shot}/{character}/delivery/keys.csv",
        error="results/takes/{shot}/{character}/delivery/keys.json",
    log:
        "logs/delivery_curves/{shot}/{character}.log",
    benchmark:
        "logs/delivery_curves/{shot}/{character}.tsv"
    wildcard_constraints:
        character=delivered_on_blendshapes(),
