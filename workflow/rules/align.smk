"""Head motion told apart from the face's own motion, against the session's neutral.

Needs performance.parquet. Makes head_motion.parquet and expression.parquet of each shot.
"""


rule align_head:
    input:
        performance="results/shots/{shot}/performance.parquet",
        neutral=neutral_of,
    output:
        head_motion="results/shots/{shot}/head_motion.parquet",
        expression="results/shots/{shot}/expression.parquet",
    log:
        "logs/align_head/{shot}.log",
    benchmark:
        "logs/align_head/{shot}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("align_head"),
        neutral_frame=session_cell("neutral_frame"),
        unit_points=session_cell("unit_points"),
        unit_markers=session_cell("unit_markers"),
        origin_marker=session_cell("origin_marker"),
        head=session_cell("head"),
        head_method=session_cell("head_method"),
        seed=config["seed"],
    shell:
        "python -m stages.align_head"
        " --performance {input.performance:q}"
        " --neutral {input.neutral:q}"
        " --neutral-frame {params.neutral_frame}"
        " --unit-points {params.unit_points:q}"
        " --unit-markers={params.unit_markers:q}"
        " --origin-marker={params.origin_marker:q}"
        " --head {params.head:q}"
        " --head-method {params.head_method:q}"
        " --seed {params.seed}"
        " --head-motion {output.head_motion:q}"
        " --expression {output.expression:q}"
        " 2> {log:q}"
