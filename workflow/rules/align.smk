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
        head=session_cell("head"),
        seed=config["seed"],
    shell:
        "python -m stages.align_head"
        " --performance {input.performance:q}"
        " --neutral {input.neutral:q}"
        " --neutral-frame {params.neutral_frame}"
        " --unit-points {params.unit_points:q}"
        " --head {params.head:q}"
        " --seed {params.seed}"
        " --head-motion {output.head_motion:q}"
        " --expression {output.expression:q}"
        " 2> {log:q}"
