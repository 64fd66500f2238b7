"""Learn from tuned pairs how an actor's points set the weights of a rig (D06 sections 5 and 6).

Points become differences from the session's neutral and are projected on the principal axes of the
basis shots. `rbf` is the published network of Gaussians, `linear` a ridge regression, `rbf_linear`
both in one. Dimensions and widths that are cross-validated are those that predict each pair best
from all the others. Nothing is random.

Pairs that contradict the others are written down, the worst first. Where the network has no linear
part they are judged by the ridge regression, since few dimensions alone make good pairs look bad.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import (
    pair_contradictions,
    partial_projection,
    rbf,
    regression_choice,
    weight_regression,
)
from stages.files import (
    actor_points,
    channels,
    driving_points,
    errors,
    pair_residuals,
    pairs,
    rbf_model,
    rig,
)

CROSS_VALIDATED, PUBLISHED = "cross_validated", "published"


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--pairs", required=True, nargs="*", help="tuned pairs, a .tsv or .csv for each animator"
    )
    parser.add_argument(
        "--expressions", required=True, nargs="+", help="basis shots' expressions, .parquet"
    )
    parser.add_argument("--shots", required=True, nargs="+", help="names of these shots")
    parser.add_argument(
        "--other-shots", nargs="*", default=[], help="shots of other actors: their pairs are left"
    )
    parser.add_argument(
        "--points", required=True, choices=list(driving_points.AXES), help="which of their points"
    )
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument("--channels", required=True, help="table of the channels, or ''")
    parser.add_argument(
        "--regression", required=True, choices=weight_regression.METHODS, help="the function"
    )
    parser.add_argument(
        "--dimensions", required=True, help="principal components, from 1, or cross_validated"
    )
    parser.add_argument(
        "--widths",
        required=True,
        choices=[PUBLISHED, CROSS_VALIDATED],
        help="of the Gaussians; published: the RMS distance of two pairs",
    )
    parser.add_argument(
        "--min-confidence",
        required=True,
        type=float,
        help="frames of lower confidence, 0 to 1, are left out of the principal components",
    )
    parser.add_argument("--rbf", required=True, help="regression to write, .npz")
    parser.add_argument("--residuals", required=True, help="doubtful pairs to write, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read points and pairs, choose and train the regression, write it and the doubtful pairs."""
    options = build_parser().parse_args(argv)
    points = actor_points.read(options.expressions, options.shots, options.points)
    shapes = rig.read_any(options.rig).names
    limits = channels.read(options.channels, shapes, 0.0, 1.0)
    tuned = pairs.read(options.pairs, points.shots, options.other_shots, limits)
    dimensions = _dimensions(options, len(tuned))
    count = max(dimensions or 0, regression_choice.MOST)
    first = options.expressions[0]
    axes, noise = actor_points.axes(first, points, options.min_confidence, count)
    if dimensions and dimensions > len(axes.variance):
        message = f"{dimensions}, but the points move in {len(axes.variance)}: lower it"
        raise errors.InputError("--dimensions", message)
    examples = partial_projection.project(axes, noise, _tuned_frames(points, tuned))
    targets = np.stack([pair.weights for pair in tuned])
    form = regression_choice.choose(
        examples, targets, options.regression, dimensions, options.widths == PUBLISHED
    )
    cli.logger.info("%d pairs, %s: %s", len(tuned), options.regression, form)
    trained, _ = weight_regression.train(examples, targets, form)
    seen = examples[:, : max(form.linear_dimensions, form.rbf_dimensions)]
    learnt = rbf_model.RbfModel(
        options.points,
        points.names,
        shapes,
        axes,
        noise,
        trained,
        seen,
        rbf.nearest_distance(seen),
        {"method": options.regression, "form": form._asdict()},
    )
    sources = [*options.pairs, *options.expressions, options.rig]
    sources += [options.channels] if options.channels else []
    rbf_model.write(options.rbf, learnt, sources)
    doubtful = _doubtful(tuned, examples, targets, form)
    pair_residuals.write(options.residuals, doubtful, sources)


def _dimensions(options: argparse.Namespace, count: int) -> int | None:
    """Return the number of dimensions that was asked for, or None where it is to be chosen."""
    first = options.pairs[0] if options.pairs else "pairs of the character"
    if count < regression_choice.FEWEST:
        message = f"{count} pairs of {', '.join(options.shots)}: tune"
        cure = f"{regression_choice.FEWEST} at least, the page of reference frames says which"
        raise errors.InputError(first, f"{message} {cure}")
    if options.dimensions == CROSS_VALIDATED:
        return None
    if not options.dimensions.isdecimal() or int(options.dimensions) == 0:
        message = f"'{options.dimensions}' is neither a whole number from 1 nor {CROSS_VALIDATED}"
        raise errors.InputError("--dimensions", message)
    if int(options.dimensions) > count:
        message = f"{count} pairs are fewer than the {options.dimensions} dimensions"
        cure = f"tune more, or set dimensions to {CROSS_VALIDATED}"
        raise errors.InputError(first, f"{message}: {cure}")
    return int(options.dimensions)


def _tuned_frames(points: actor_points.ActorPoints, tuned: Sequence[pairs.Pair]) -> np.ndarray:
    """Return the offsets (N, P D) of the pairs' frames, once enough of each is observed."""
    rows = [points.shots[pair.shot][pair.frame] for pair in tuned]
    offsets = points.offsets[rows]
    for pair, share in zip(tuned, actor_points.observed_share(offsets), strict=True):
        if share < actor_points.ENOUGH:
            message = f"line {pair.line}: {share:.0%} of the points are observed on frame"
            cure = "tune another frame"
            raise errors.InputError(pair.path, f"{message} {pair.frame} of {pair.shot}: {cure}")
    return offsets


def _doubtful(
    tuned: Sequence[pairs.Pair],
    examples: np.ndarray,
    targets: np.ndarray,
    form: weight_regression.Form,
) -> list[dict]:
    """Return a row for each pair, the one that fits the others least first."""
    if not form.linear_dimensions:
        form = regression_choice.choose(examples, targets, "linear")
    judge, residuals = weight_regression.train(examples, targets, form)
    misfits = targets - weight_regression.predict(judge, examples)
    doubts = pair_contradictions.doubt(residuals, misfits)
    sizes = np.sqrt(np.mean(residuals**2, axis=1))
    partners = pair_contradictions.partners(examples[:, : form.linear_dimensions], targets)
    return [
        {
            "animator": tuned[row].animator,
            "shot": tuned[row].shot,
            "frame": tuned[row].frame,
            "residual": float(sizes[row]),
            "doubt": float(doubts[row]),
            "partner_animator": tuned[partners[row]].animator,
            "partner_shot": tuned[partners[row]].shot,
            "partner_frame": tuned[partners[row]].frame,
            "rank": rank,
        }
        for rank, row in enumerate(np.argsort(-doubts, kind="stable"), start=1)
    ]


if __name__ == "__main__":
    cli.run_stage(main)
