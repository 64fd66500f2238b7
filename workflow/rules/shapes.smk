"""Key shapes of an actor, and the brief from which an artist sculpts them.

Needs expression.parquet of the actor's basis shots. Makes pca.npz, key_shapes.parquet,
key_shape_errors.parquet and the brief of each actor, and the state of each character's sculpts.
"""


rule fit_pca:
    input:
        expressions=basis_expressions,
        regions="config/regions.tsv",
    output:
        pca="results/actors/{actor}/pca.npz",
    log:
        "logs/fit_pca/{actor}.log",
    benchmark:
        "logs/fit_pca/{actor}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("fit_pca"),
        shots=basis_shots,
        min_confidence=config["min_confidence"],
    shell:
        "python -m stages.fit_pca"
        " --expressions {input.expressions:q}"
        " --shots {params.shots:q}"
        " --regions {input.regions:q}"
        " --min-confidence {params.min_confidence}"
        " --pca {output.pca:q}"
        " 2> {log:q}"


rule select_key_shapes:
    input:
        expressions=basis_expressions,
        pca="results/actors/{actor}/pca.npz",
        regions="config/regions.tsv",
        region_settings="config/region_settings.tsv",
        key_shape_table=ancient("config/key_shapes.tsv"),
    output:
        key_shapes="results/actors/{actor}/key_shapes.parquet",
        errors="results/actors/{actor}/key_shape_errors.parquet",
    log:
        "logs/select_key_shapes/{actor}.log",
    benchmark:
        "logs/select_key_shapes/{actor}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("select_key_shapes"),
        shots=basis_shots,
        lock_rows=lock_rows,
        min_confidence=config["min_confidence"],
        seed=config["seed"],
    shell:
        "python -m stages.select_key_shapes"
        " --expressions {input.expressions:q}"
        " --shots {params.shots:q}"
        " --regions {input.regions:q}"
        " --region-settings {input.region_settings:q}"
        " --key-shape-table {input.key_shape_table:q}"
        " --actor {wildcards.actor:q}"
        " --pca {input.pca:q}"
        " --min-confidence {params.min_confidence}"
        " --seed {params.seed}"
        " --key-shapes {output.key_shapes:q}"
        " --errors {output.errors:q}"
        " 2> {log:q}"


rule write_brief:
    input:
        basis_films,
        key_shapes="results/actors/{actor}/key_shapes.parquet",
        errors="results/actors/{actor}/key_shape_errors.parquet",
        tracked=basis_tracked,
        expressions=basis_expressions,
        states=sculpt_states,
        key_shape_table=ancient("config/key_shapes.tsv"),
        point_set="config/point_set.tsv",
        regions="config/regions.tsv",
        template=template("brief.html"),
    output:
        page=report(
            "results/actors/{actor}/brief/index.html",
            caption="../report/brief.rst",
            category="Briefs",
            labels={"actor": "{actor}"},
        ),
        locks="results/actors/{actor}/brief/key_shapes.tsv",
    log:
        "logs/write_brief/{actor}.log",
    benchmark:
        "logs/write_brief/{actor}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("write_brief"),
        shots=basis_shots,
        videos=basis_film_paths,
        characters=played_characters,
        lock_rows=lock_rows,
    shell:
        "python -m stages.write_brief"
        " --actor {wildcards.actor:q}"
        " --key-shapes {input.key_shapes:q}"
        " --key-shape-table {input.key_shape_table:q}"
        " --errors {input.errors:q}"
        " --shots {params.shots:q}"
        " --videos {params.videos:q}"
        " --tracked {input.tracked:q}"
        " --expressions {input.expressions:q}"
        " --point-set {input.point_set:q}"
        " --regions {input.regions:q}"
        " --characters {params.characters:q}"
        " --states {input.states:q}"
        " --template {input.template:q}"
        " --page {output.page:q}"
        " --locks {output.locks:q}"
        " 2> {log:q}"
