"""From weights and sculpts to a moving character.

Needs the weights that a method has found, head_motion.parquet and the character's folder. Makes the state of the
sculpts and rig.npz of each actor and character, and for each take weights.parquet, weights.csv and
the mesh (mesh.exr, mesh.json, mesh.pc2, mesh.glb) or the curves of named controls.
"""


rule check_sculpts:
    input:
        character_source("neutral"),
        sculpts=sculpts,
        key_shapes="results/actors/{actor}/key_shapes.parquet",
    output:
        states="results/cast/{actor}/{character}/sculpts.parquet",
    log:
        "logs/check_sculpts/{actor}/{character}.log",
    benchmark:
        "logs/check_sculpts/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("key_shapes"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("check_sculpts"),
        neutral=character_path("neutral"),
        sculpt_folder=folder_of("sculpts"),
    shell:
        "python -m stages.check_sculpts"
        " --key-shapes {input.key_shapes:q}"
        " --neutral {params.neutral:q}"
        " --sculpts {input.sculpts:q}"
        " --sculpt-folder {params.sculpt_folder:q}"
        " --character {wildcards.character:q}"
        " --states {output.states:q}"
        " 2> {log:q}"


rule assemble_rig:
    input:
        character_source("neutral"),
        character_source("masks"),
        sculpts=sculpts,
        key_shapes="results/actors/{actor}/key_shapes.parquet",
    output:
        rig="results/cast/{actor}/{character}/rig.npz",
    log:
        "logs/assemble_rig/{actor}/{character}.log",
    benchmark:
        "logs/assemble_rig/{actor}/{character}.tsv"
    wildcard_constraints:
        character=of_method("key_shapes"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("assemble_rig"),
        neutral=character_path("neutral"),
        masks=character_path("masks"),
        sculpt_folder=folder_of("sculpts"),
        unit=character_cell("unit"),
        up_axis=character_cell("up_axis"),
        pivot=character_cell("pivot"),
        face_unit=character_cell("face_unit"),
    shell:
        "python -m stages.assemble_rig"
        " --key-shapes {input.key_shapes:q}"
        " --neutral {params.neutral:q}"
        " --sculpts {input.sculpts:q}"
        " --sculpt-folder {params.sculpt_folder:q}"
        " --masks {params.masks:q}"
        " --unit {params.unit:q}"
        " --up-axis {params.up_axis:q}"
        " --pivot={params.pivot:q}"
        " --face-unit {params.face_unit}"
        " --rig {output.rig:q}"
        " 2> {log:q}"


rule shape_motion:
    input:
        curve_channels_source,
        solution=solution_of,
        head_motion=head_motion_of,
        rig=rig_of,
    output:
        shaped="results/takes/{shot}/{character}/shaped.parquet",
        shaped_head="results/takes/{shot}/{character}/shaped_head.parquet",
    log:
        "logs/shape_motion/{shot}/{character}.log",
    benchmark:
        "logs/shape_motion/{shot}/{character}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("shape_motion"),
        channels=curve_channels,
        head_gain=character_cell("head_gain"),
        head_limit=character_cell("head_limit"),
        head_axes=character_cell("head_axes"),
        follow_s=character_cell("follow_s"),
        damping=character_cell("damping"),
        followed=character_cell("followed"),
    shell:
        "python -m stages.shape_motion"
        " --solution {input.solution:q}"
        " --head-motion {input.head_motion:q}"
        " --rig {input.rig:q}"
        " --channels={params.channels:q}"
        " --head-gain={params.head_gain:q}"
        " --head-limit={params.head_limit:q}"
        " --head-axes={params.head_axes:q}"
        " --follow-s {params.follow_s}"
        " --damping {params.damping}"
        " --followed {params.followed:q}"
        " --shaped {output.shaped:q}"
        " --shaped-head {output.shaped_head:q}"
        " 2> {log:q}"


rule learn_dynamics:
    input:
        solutions=basis_solutions,
        rig="results/cast/{actor}/{character}/rig.npz",
    output:
        dynamics="results/cast/{actor}/{character}/dynamics.npz",
    log:
        "logs/learn_dynamics/{actor}/{character}.log",
    benchmark:
        "logs/learn_dynamics/{actor}/{character}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("learn_dynamics"),
    shell:
        "python -m stages.learn_dynamics"
        " --solutions {input.solutions:q}"
        " --rig {input.rig:q}"
        " --dynamics {output.dynamics:q}"
        " 2> {log:q}"


rule smooth_weights:
    input:
        cut_film_source,
        curve_channels_source,
        solution=smoothed_solution,
        head_motion=smoothed_head_motion,
        expression=expression_of,
        rig=rig_of,
        dynamics=dynamics_of,
        edits=edits_of,
    output:
        weights="results/takes/{shot}/{character}/weights.parquet",
        csv="results/takes/{shot}/{character}/weights.csv",
    log:
        "logs/smooth_weights/{shot}/{character}.log",
    benchmark:
        "logs/smooth_weights/{shot}/{character}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("smooth_weights"),
        channels=curve_channels,
        smoothing=character_cell("smoothing"),
        gap_filling=character_cell("gap_filling"),
        tempo=character_cell("tempo"),
        lip_points=lip_points_of,
        first_frame=shot_cell("first_frame"),
        last_frame=shot_cell("last_frame"),
        handles=shot_cell("handles"),
        start_timecode=shot_cell("start_timecode"),
        video=cut_film,
        rate=character_cell("rate"),
        head=character_cell("head"),
    shell:
        "python -m stages.smooth_weights"
        " --solution {input.solution:q}"
        " --head-motion {input.head_motion:q}"
        " --expression {input.expression:q}"
        " --rig {input.rig:q}"
        " --channels={params.channels:q}"
        " --smoothing {params.smoothing:q}"
        " --gap-filling {params.gap_filling:q}"
        " --dynamics {input.dynamics:q}"
        " --tempo {params.tempo}"
        " --lip-points={params.lip_points:q}"
        " --rate={params.rate:q}"
        " --head {params.head:q}"
        " --edits {input.edits:q}"
        " --first-frame={params.first_frame:q}"
        " --last-frame={params.last_frame:q}"
        " --handles={params.handles:q}"
        " --start-timecode={params.start_timecode:q}"
        " --video {params.video:q}"
        " --weights {output.weights:q}"
        " --csv {output.csv:q}"
        " 2> {log:q}"


rule bake_mesh:
    input:
        rig=rig_of,
        weights="results/takes/{shot}/{character}/weights.parquet",
    output:
        exr="results/takes/{shot}/{character}/mesh.exr",
        json="results/takes/{shot}/{character}/mesh.json",
        pc2="results/takes/{shot}/{character}/mesh.pc2",
        glb="results/takes/{shot}/{character}/mesh.glb",
    log:
        "logs/bake_mesh/{shot}/{character}.log",
    benchmark:
        "logs/bake_mesh/{shot}/{character}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("bake_mesh"),
        most_targets=character_cell("most_targets"),
    shell:
        "python -m stages.bake_mesh"
        " --rig {input.rig:q}"
        " --weights {input.weights:q}"
        " --most-targets {params.most_targets}"
        " --exr {output.exr:q}"
        " --json {output.json:q}"
        " --pc2 {output.pc2:q}"
        " --glb {output.glb:q}"
        " 2> {log:q}"


rule bake_controls:
    input:
        rig=rig_of,
        weights="results/takes/{shot}/{character}/weights.parquet",
    output:
        controls="results/takes/{shot}/{character}/controls.parquet",
        csv="results/takes/{shot}/{character}/controls.csv",
    log:
        "logs/bake_controls/{shot}/{character}.log",
    benchmark:
        "logs/bake_controls/{shot}/{character}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("bake_controls"),
    shell:
        "python -m stages.bake_controls"
        " --rig {input.rig:q}"
        " --weights {input.weights:q}"
        " --controls {output.controls:q}"
        " --csv {output.csv:q}"
        " 2> {log:q}"


rule retime_sound:
    input:
        take_sound_source,
    output:
        retimed="results/takes/{shot}/{character}/sound.flac",
    log:
        "logs/retime_sound/{shot}/{character}.log",
    benchmark:
        "logs/retime_sound/{shot}/{character}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("retime_sound"),
        sound=take_sound,
        tempo=character_cell("tempo"),
    shell:
        "python -m stages.retime_sound"
        " --sound {params.sound:q}"
        " --tempo {params.tempo}"
        " --retimed {output.retimed:q}"
        " 2> {log:q}"
