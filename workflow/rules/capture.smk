"""From films and labels to tracked points on a constant clock.

Needs a session's films and labels. Makes tracker.npz and label_proposals.tsv of each session, and
tracked.parquet (at the film's own times) and performance.parquet (at a constant rate) of each shot.
"""


rule train_tracker:
    input:
        training_sources,
        point_set="config/point_set.tsv",
    output:
        tracker="results/sessions/{session}/tracker.npz",
    log:
        "logs/train_tracker/{session}.log",
    benchmark:
        "logs/train_tracker/{session}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("train_tracker"),
        shots=labelled("shot"),
        videos=labelled("video"),
        labels=labelled("labels"),
        method=config["tracker_method"],
        seed=config["seed"],
    shell:
        "python -m stages.train_tracker"
        " --shots {params.shots:q}"
        " --videos {params.videos:q}"
        " --labels {params.labels:q}"
        " --point-set {input.point_set:q}"
        " --method {params.method:q}"
        " --seed {params.seed}"
        " --tracker {output.tracker:q}"
        " 2> {log:q}"


rule track_video:
    input:
        shot_source("video"),
        tracker=tracker_of,
    output:
        tracked="results/shots/{shot}/tracked.parquet",
    log:
        "logs/track_video/{shot}.log",
    benchmark:
        "logs/track_video/{shot}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("track_video"),
        video=shot_cell("video"),
    shell:
        "python -m stages.track_video"
        " --tracker {input.tracker:q}"
        " --video {params.video:q}"
        " --tracked {output.tracked:q}"
        " 2> {log:q}"


rule propose_labels:
    input:
        tracked=session_tracked,
    output:
        proposals="results/sessions/{session}/label_proposals.tsv",
    log:
        "logs/propose_labels/{session}.log",
    benchmark:
        "logs/propose_labels/{session}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("propose_labels"),
        shots=session_shots,
        labelled_shots=labelled("shot"),
        labels=labelled("labels"),
    shell:
        "python -m stages.propose_labels"
        " --tracked {input.tracked:q}"
        " --shots {params.shots:q}"
        " --labelled-shots {params.labelled_shots:q}"
        " --labels {params.labels:q}"
        " --proposals {output.proposals:q}"
        " 2> {log:q}"


rule merge_capture:
    input:
        merged_film_source,
        tracked=tracked_of,
        markers=markers_of,
        sync=sync_of,
    output:
        performance="results/shots/{shot}/performance.parquet",
    log:
        "logs/merge_capture/{shot}.log",
    benchmark:
        "logs/merge_capture/{shot}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("merge_capture"),
        video=merged_film,
    shell:
        "python -m stages.merge_capture"
        " --tracked {input.tracked:q}"
        " --markers {input.markers:q}"
        " --sync {input.sync:q}"
        " --video {params.video:q}"
        " --performance {output.performance:q}"
        " 2> {log:q}"


rule sync_audio:
    input:
        shot_source("video"),
        shot_source("sound"),
    output:
        sync="results/shots/{shot}/sync.json",
    log:
        "logs/sync_audio/{shot}.log",
    benchmark:
        "logs/sync_audio/{shot}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("sync_audio"),
        video=shot_cell("video"),
        sound=shot_cell("sound"),
        offset_s=shot_cell("sync_offset_s"),
    shell:
        "python -m stages.sync_audio"
        " --video {params.video:q}"
        " --sound={params.sound:q}"
        " --offset-s={params.offset_s:q}"
        " --sync {output.sync:q}"
        " 2> {log:q}"


rule align_phones:
    input:
        shot_source("phones"),
        shot_source("transcript"),
        shot_source("words"),
        sound_source,
        sync=sound_sync_of,
        visemes=data_table("visemes.tsv"),
    output:
        phones_out="results/shots/{shot}/phones.parquet",
    log:
        "logs/align_phones/{shot}.log",
    benchmark:
        "logs/align_phones/{shot}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("align_phones"),
        phones=shot_files("phones"),
        transcript=shot_files("transcript"),
        words=shot_files("words"),
        sound=sound_of,
    shell:
        "python -m stages.align_phones"
        " --phones {params.phones:q}"
        " --transcript {params.transcript:q}"
        " --words {params.words:q}"
        " --sound {params.sound:q}"
        " --sync {input.sync:q}"
        " --visemes {input.visemes:q}"
        " --phones-out {output.phones_out:q}"
        " 2> {log:q}"


rule import_markers:
    input:
        shot_source("markers"),
        session_source("marker_map"),
    output:
        markers="results/shots/{shot}/markers.parquet",
        faults="results/shots/{shot}/marker_faults.tsv",
    log:
        "logs/import_markers/{shot}.log",
    benchmark:
        "logs/import_markers/{shot}.tsv"
    conda:
        "../envs/stages.yaml"
    threads: 1
    params:
        code=code_of("import_markers"),
        marker_file=shot_cell("markers"),
        marker_map=session_cell("marker_map"),
        unit=session_cell("marker_unit"),
        axes=session_cell("marker_axes"),
        rate=session_cell("source_rate"),
        max_gap_s=config["max_marker_gap_s"],
    shell:
        "python -m stages.import_markers"
        " --marker-file {params.marker_file:q}"
        " --marker-map={params.marker_map:q}"
        " --unit {params.unit:q}"
        " --axes={params.axes:q}"
        " --rate={params.rate:q}"
        " --max-gap-s {params.max_gap_s}"
        " --markers {output.markers:q}"
        " --faults {output.faults:q}"
        " 2> {log:q}"
