"""Takes in further formats, as the column outputs of characters.tsv asks for them.

Needs a take's mesh.exr, or its weights and the character's rig. Makes one or more files beside them.
"""


rule export_mdd:
    input:
        exr="results/takes/{shot}/{character}/mesh.exr",
        json="results/takes/{shot}/{character}/mesh.json",
    output:
        mdd="results/takes/{shot}/{character}/mesh.mdd",
    log:
        "logs/export_mdd/{shot}/{character}.log",
    benchmark:
        "logs/export_mdd/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_kind("mesh"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("export_mdd"),
    shell:
        "python -m stages.export_mdd"
        " --exr {input.exr:q}"
        " --json {input.json:q}"
        " --mdd {output.mdd:q}"
        " 2> {log:q}"


rule export_usd:
    input:
        rig=rig_of,
        weights="results/takes/{shot}/{character}/weights.parquet",
    output:
        usd="results/takes/{shot}/{character}/mesh.usdc",
        points="results/takes/{shot}/{character}/points.usdc",
    log:
        "logs/export_usd/{shot}/{character}.log",
    benchmark:
        "logs/export_usd/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_kind("mesh"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("export_usd"),
    shell:
        "python -m stages.export_usd"
        " --rig {input.rig:q}"
        " --weights {input.weights:q}"
        " --usd {output.usd:q}"
        " --points {output.points:q}"
        " 2> {log:q}"


rule export_obj:
    input:
        exr="results/takes/{shot}/{character}/mesh.exr",
        json="results/takes/{shot}/{character}/mesh.json",
        rig=rig_of,
    output:
        obj_folder=directory("results/takes/{shot}/{character}/obj"),
    log:
        "logs/export_obj/{shot}/{character}.log",
    benchmark:
        "logs/export_obj/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_kind("mesh"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("export_obj"),
    shell:
        "python -m stages.export_obj"
        " --exr {input.exr:q}"
        " --json {input.json:q}"
        " --rig {input.rig:q}"
        " --obj-folder {output.obj_folder:q}"
        " 2> {log:q}"


rule export_texture:
    input:
        exr="results/takes/{shot}/{character}/mesh.exr",
        json="results/takes/{shot}/{character}/mesh.json",
        rig=rig_of,
    output:
        texture="results/takes/{shot}/{character}/texture/{layout}/texture.exr",
        normals="results/takes/{shot}/{character}/texture/{layout}/texture_normals.exr",
        texture_json="results/takes/{shot}/{character}/texture/{layout}/texture.json",
        texture_mesh="results/takes/{shot}/{character}/texture/{layout}/texture_mesh.obj",
    log:
        "logs/export_texture/{shot}/{character}/{layout}.log",
    benchmark:
        "logs/export_texture/{shot}/{character}/{layout}.tsv"
    wildcard_constraints:
        character=of_kind("mesh"),
        layout="plain|openvat",
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("export_texture"),
    shell:
        "python -m stages.export_texture"
        " --exr {input.exr:q}"
        " --json {input.json:q}"
        " --rig {input.rig:q}"
        " --layout {wildcards.layout:q}"
        " --texture {output.texture:q}"
        " --normals {output.normals:q}"
        " --texture-json {output.texture_json:q}"
        " --texture-mesh {output.texture_mesh:q}"
        " 2> {log:q}"


rule export_blender:
    input:
        rig=rig_of,
        weights="results/takes/{shot}/{character}/weights.parquet",
        template=template("apply_in_blender.py"),
    output:
        script="results/takes/{shot}/{character}/blender.py",
    log:
        "logs/export_blender/{shot}/{character}.log",
    benchmark:
        "logs/export_blender/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_kind("mesh"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("export_blender"),
    shell:
        "python -m stages.export_blender"
        " --rig {input.rig:q}"
        " --weights {input.weights:q}"
        " --template {input.template:q}"
        " --script {output.script:q}"
        " 2> {log:q}"


rule export_curves:
    input:
        rig=rig_of,
        weights="results/takes/{shot}/{character}/weights.parquet",
    output:
        key_table="results/takes/{shot}/{character}/keys.csv",
        error="results/takes/{shot}/{character}/keys.json",
    log:
        "logs/export_curves/{shot}/{character}.log",
    benchmark:
        "logs/export_curves/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_kind("mesh"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("export_curves"),
    shell:
        "python -m stages.export_curves"
        " --rig {input.rig:q}"
        " --weights {input.weights:q}"
        " --key-table {output.key_table:q}"
        " --error {output.error:q}"
        " 2> {log:q}"


rule export_livelink:
    input:
        rig=rig_of,
        weights="results/takes/{shot}/{character}/weights.parquet",
        names=data_table("shape_names.tsv"),
    output:
        livelink="results/takes/{shot}/{character}/livelink.csv",
    log:
        "logs/export_livelink/{shot}/{character}.log",
    benchmark:
        "logs/export_livelink/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_method("rbf", "blendshapes"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("export_livelink"),
    shell:
        "python -m stages.export_livelink"
        " --rig {input.rig:q}"
        " --weights {input.weights:q}"
        " --names {input.names:q}"
        " --livelink {output.livelink:q}"
        " 2> {log:q}"


rule export_maya:
    input:
        rig=rig_of,
        weights="results/takes/{shot}/{character}/weights.parquet",
        template=template("apply_in_maya.py"),
    output:
        script="results/takes/{shot}/{character}/maya.py",
        anim="results/takes/{shot}/{character}/maya.anim",
    log:
        "logs/export_maya/{shot}/{character}.log",
    benchmark:
        "logs/export_maya/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_kind("mesh"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("export_maya"),
    shell:
        "python -m stages.export_maya"
        " --rig {input.rig:q}"
        " --weights {input.weights:q}"
        " --template {input.template:q}"
        " --script {output.script:q}"
        " --anim {output.anim:q}"
        " 2> {log:q}"
