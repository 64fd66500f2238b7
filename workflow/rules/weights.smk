"""Weights of the key shapes on every frame of a shot, shared by all characters.

Needs expression.parquet of the shot and key_shapes.parquet of its actor. Makes key_weights.parquet.
"""


rule solve_weights:
    input:
        expression="results/shots/{shot}/expression.parquet",
        key_shapes=key_shapes_of_shot,
        regions="config/regions.tsv",
        region_settings="config/region_settings.tsv",
    output:
        key_weights="results/shots/{shot}/key_weights.parquet",
    log:
        "logs/solve_weights/{shot}.log",
    benchmark:
        "logs/solve_weights/{shot}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("solve_weights"),
    shell:
        "python -m stages.solve_weights"
        " --expression {input.expression:q}"
        " --key-shapes {input.key_shapes:q}"
        " --regions {input.regions:q}"
        " --region-settings {input.region_settings:q}"
        " --key-weights {output.key_weights:q}"
        " 2> {log:q}"
