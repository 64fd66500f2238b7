"""Errors in the target: what the layers of the vignette make of characters, against the truth."""

import numpy as np

from bench import layer_bodies, layer_motion, layer_rivals, layer_vignette
from data_example.generator import clay_shapes
from stages.core import coordinate_balance, local_shapes
from stages.files import rig

How = layer_vignette.How
EXAGGERATED = 1.1
BEYOND = (0.0, 0.15, 0.3, 0.5, 0.7, 1.0)
SOFT = {
    "as by default": layer_vignette.DEFAULT,
    "no bias": How(0.0),
    "markers, no bias": How(0.0, points="markers"),
    "markers, nothing held": How(0.0, 0.0, points="markers", lean=0.0),
}


def planted(take: layer_vignette.Take) -> list[str]:
    """Return lines: errors against the planted layers on every character [mm]."""
    cases = {
        "as by default": layer_vignette.DEFAULT,
        "no lip bias": How(lip_sigma=0.0),
        "no lip bias, no lean": How(lip_sigma=0.0, lean=0.0),
        "no lip bias, beyond 0.7": How(lip_sigma=0.0, beyond=0.7),
        "nothing held (temporal 0)": How(lip_sigma=0.0, temporal=0.0),
    }
    lines = []
    for name in layer_vignette.CHARACTERS:
        body = layer_bodies.body(take, name)
        true = layer_bodies.displaced(body, take.planted)
        lines.append(layer_vignette.row(f"{name} [mm]", ["all", *take.made.masks]))
        for label, u in {label: take.solve(how).u for label, how in cases.items()}.items():
            moved = layer_bodies.displaced(body, u)
            lines.append(
                layer_vignette.row(
                    "  " + label, layer_bodies.distance(body, moved, true).mean(axis=0)
                )
            )
        nearest = layer_bodies.displaced(body, normalised(take))
        lines.append(
            layer_vignette.row(
                "  truth with strengths summing to 1",
                layer_bodies.distance(body, nearest, true).mean(axis=0),
            )
        )
        lines.append(
            layer_vignette.row(
                "  standing still", layer_bodies.distance(body, 0 * true, true).mean(axis=0)
            )
        )
    return lines


def normalised(take: layer_vignette.Take) -> np.ndarray:
    """Return what was planted, divided where layers together exceed one (T, R, K).

    The neutral extremes move nothing, so what the others hold counts alone.
    """
    still = [name in ("neutral", "rest", "open") for _, name in take.made.extremes]
    moving = np.where(still, 0.0, take.planted)
    return moving / np.maximum(moving.sum(axis=2, keepdims=True), 1.0)


def clay_truth(take: layer_vignette.Take, expression: np.ndarray) -> np.ndarray:
    """Return the displacements (T, V, 3) [mm] of the clay head that plays an expression."""
    made = rig.read_any(take.show / "results/cast/mia/clay/rig.npz")
    names = [name.partition(".")[2] for name in made.names]
    weights = clay_shapes.weights(expression.astype(float))
    order = [clay_shapes.NAMES.index(name) for name in names]
    deltas = local_shapes.dense(made.deltas) * 1000 * rig.METRES[made.unit]
    flat = weights[:, order] @ deltas.reshape(len(deltas), -1)
    return flat.reshape(len(weights), -1, 3)


def true_poses(take: layer_vignette.Take, body: layer_bodies.Body) -> layer_bodies.Body:
    """Return the clay head with poses that are what she does, not what the artist made of it."""
    names = list(take.truth["extreme_names"])
    order = [names.index("_".join(extreme)) for extreme in take.made.extremes]
    posed = clay_truth(take, take.truth["poses"][order])
    moves = [body.masks[mask][:, None] * posed[k] for mask, k in body.columns]
    return body._replace(moves=np.array(moves))


def rivals(take: layer_vignette.Take) -> list[str]:
    """Return lines: errors of several methods against the clay head's truth by expression [mm]."""
    body = layer_bodies.body(take, "clay_layers")
    true = clay_truth(take, take.truth["expression"])
    ideal = true_poses(take, body)
    made = {"standing still": 0 * true}
    for label, how in {
        "layers": layer_vignette.DEFAULT,
        "layers, no bias": How(lip_sigma=0.0),
        "layers of markers, no bias": How(0.0, points="markers"),
        "layers of markers, no bias, nothing held": How(0.0, 0.0, points="markers"),
        "the same, no lean": How(0.0, 0.0, points="markers", lean=0.0),
        "the same, no lean, beyond 0.7": How(0.0, 0.0, 0.7, points="markers", lean=0.0),
    }.items():
        u = take.solve(how).u
        made[label + "; artist's poses"] = layer_bodies.displaced(body, u)
        made[label + "; true poses"] = layer_bodies.displaced(ideal, u)
    made["planted layers; artist's poses"] = layer_bodies.displaced(body, take.planted)
    made["planted layers; true poses"] = layer_bodies.displaced(ideal, take.planted)
    faces = clay_truth(take, np.load(take.show / "data_example/truth/faces.npz")["expression"])
    for kinds in ("both", "markers"):
        for counts in layer_rivals.COUNTS:
            label = f"key shapes of {kinds}, " + "/".join(map(str, counts))
            made[label] = layer_rivals.key_shapes(take, body.masks, faces, counts, kinds)
    made["rbf of markers, pairs of capture"] = layer_rivals.rbf_network(take)
    talks, strong = layer_vignette.talking(take), exaggerated(take)
    lines = [layer_vignette.row("", ["all", *take.made.masks, "talking", "strong"])]
    for label, moved in made.items():
        found = layer_bodies.distance(body, moved, true)
        cells = [*found.mean(axis=0), found[talks, 0].mean(), found[strong, 0].mean()]
        lines.append(layer_vignette.row(label, cells, first=58))
    lines[0] = layer_vignette.row("", ["all", *take.made.masks, "talking", "strong"], first=58)
    return lines


def exaggerated(take: layer_vignette.Take) -> np.ndarray:
    """Return on which frames (T,) a planted strength is well above 1."""
    return take.truth["strength"].astype(float).max(axis=(1, 2)) > EXAGGERATED


def beyond(take: layer_vignette.Take) -> list[str]:
    """Return lines: errors by how far masks may exceed one, and jitter of the clay head [mm].

    By expression of every mask, on all frames and on exaggerated ones; against the planted layers.
    """
    strong = exaggerated(take)
    lines = [f"{strong.mean():.0%} of the frames are exaggerated (strong)"]
    heads = ["by expr.", *take.made.masks, "strong", *(f"{m}, s." for m in take.made.masks)]
    heads += ["clay", "strong", "mouth", "tortoise", "strong", "jitter"]
    lines.append(layer_vignette.row("", heads, 10))
    clay, tortoise = (layer_bodies.body(take, name) for name in ("clay_layers", "tortoise"))
    ideal = true_poses(take, clay)
    by_expression = clay_truth(take, take.truth["expression"])
    planted_on = {b.name: layer_bodies.displaced(b, take.planted) for b in (clay, tortoise)}
    mouth = 1 + take.made.masks.index("mouth")
    for label, how in SOFT.items():
        for how_far in BEYOND:
            u = take.solve(how._replace(beyond=how_far)).u
            found = layer_bodies.distance(ideal, layer_bodies.displaced(ideal, u), by_expression)
            cells = [*found.mean(axis=0), *found[strong].mean(axis=0)]
            moved = {b.name: layer_bodies.displaced(b, u) for b in (clay, tortoise)}
            wrong = {
                b.name: layer_bodies.distance(b, moved[b.name], planted_on[b.name])
                for b in (clay, tortoise)
            }
            all_over = wrong[clay.name][:, 0]
            cells += [all_over.mean(), all_over[strong].mean(), wrong[clay.name][:, mouth].mean()]
            all_over = wrong[tortoise.name][:, 0]
            cells += [all_over.mean(), all_over[strong].mean()]
            cells.append(layer_motion.jitter(moved[clay.name], clay, take.rate))
            lines.append(layer_vignette.row(f"{label}, beyond {how_far:g}", cells, 10))
    return lines


def balances(take: layer_vignette.Take) -> list[str]:
    """Return lines: errors by rule of balance and kind of points [mm]."""
    clay, tortoise = (layer_bodies.body(take, name) for name in ("clay_layers", "tortoise"))
    ideal = true_poses(take, clay)
    cases = (
        (tortoise, layer_bodies.displaced(tortoise, take.planted)),
        (clay, layer_bodies.displaced(clay, take.planted)),
        (ideal, clay_truth(take, take.truth["expression"])),
    )
    heads = ["tortoise", "clay", "clay by expr."]
    lines = [layer_vignette.row("no lip bias; then with it", heads * 2, width=14)]
    for points in ("markers", "video", "both"):
        for rule in coordinate_balance.RULES:
            cells = []
            for sigma in (0.0, 0.02):
                u = take.solve(How(lip_sigma=sigma, points=points, balance=rule)).u
                for body, true in cases:
                    found = layer_bodies.distance(body, layer_bodies.displaced(body, u), true)
                    cells.append(found[:, 0].mean())
            lines.append(layer_vignette.row(f"{points}, {rule}", cells, width=14))
    return lines
