"""What people look at.

Needs a take's mesh and its shot's film, tracked points or markers. Makes preview.mp4, of a mesh or of the
curves of named controls, and the run's report.
"""


rule render_preview:
    input:
        shot_source("video"),
        tracked=shown_tracked,
        performance=shown_performance,
        curves=shown_curves,
        point_set="config/point_set.tsv",
        regions="config/regions.tsv",
        exr="results/takes/{shot}/{character}/mesh.exr",
        json="results/takes/{shot}/{character}/mesh.json",
        rig=rig_of,
    output:
        preview=report(
            "results/takes/{shot}/{character}/preview.mp4",
            caption="../report/preview.rst",
            category="Takes",
            subcategory="{shot}",
            labels={"character": "{character}"},
        ),
    log:
        "logs/render_preview/{shot}/{character}.log",
    benchmark:
        "logs/render_preview/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_kind("mesh"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("render_preview"),
        video=shot_cell("video"),
        tempo=character_cell("tempo"),
    shell:
        "python -m stages.render_preview"
        " --video={params.video:q}"
        " --tempo {params.tempo}"
        " --tracked {input.tracked:q}"
        " --performance {input.performance:q}"
        " --curves {input.curves:q}"
        " --point-set {input.point_set:q}"
        " --regions {input.regions:q}"
        " --exr {input.exr:q}"
        " --json {input.json:q}"
        " --rig {input.rig:q}"
        " --shot {wildcards.shot:q}"
        " --character {wildcards.character:q}"
        " --preview {output.preview:q}"
        " 2> {log:q}"


rule render_controls:
    input:
        shot_source("video"),
        tracked=shown_tracked,
        performance=shown_performance,
        curves=shown_curves,
        point_set="config/point_set.tsv",
        regions="config/regions.tsv",
        controls="results/takes/{shot}/{character}/controls.parquet",
    output:
        preview=report(
            "results/takes/{shot}/{character}/preview.mp4",
            caption="../report/preview.rst",
            category="Takes",
            subcategory="{shot}",
            labels={"character": "{character}"},
        ),
    log:
        "logs/render_controls/{shot}/{character}.log",
    benchmark:
        "logs/render_controls/{shot}/{character}.tsv"
    wildcard_constraints:
        character=of_kind("controls"),
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("render_controls"),
        video=shot_cell("video"),
        tempo=character_cell("tempo"),
    shell:
        "python -m stages.render_controls"
        " --video={params.video:q}"
        " --tempo {params.tempo}"
        " --tracked {input.tracked:q}"
        " --performance {input.performance:q}"
        " --curves {input.curves:q}"
        " --point-set {input.point_set:q}"
        " --regions {input.regions:q}"
        " --controls {input.controls:q}"
        " --shot {wildcards.shot:q}"
        " --character {wildcards.character:q}"
        " --preview {output.preview:q}"
        " 2> {log:q}"
