"""keyface: from a filmed performance to animated characters. See README.md."""

from snakemake.utils import min_version

min_version("9.27")


configfile: "config/config.yaml"


include: "workflow/rules/checks.smk"
include: "workflow/rules/common.smk"
include: "workflow/rules/inputs.smk"
include: "workflow/rules/cast_inputs.smk"
include: "workflow/rules/take_inputs.smk"
include: "workflow/rules/layer_inputs.smk"
include: "workflow/rules/targets.smk"
include: "workflow/rules/imports.smk"
include: "workflow/rules/capture.smk"
include: "workflow/rules/align.smk"
include: "workflow/rules/shapes.smk"
include: "workflow/rules/weights.smk"
include: "workflow/rules/rbf.smk"
include: "workflow/rules/layers.smk"
include: "workflow/rules/bake.smk"
include: "workflow/rules/exports.smk"
include: "workflow/rules/delivery.smk"
include: "workflow/rules/review.smk"


rule all:
    default_target: True
    input:
        label_proposals(),
        briefs(),
        reference_pages(),
        expression_pages(),
        rig_checks(),
        takes(),


onsuccess:
    shell(report_command())


onerror:
    shell(report_command())
