"""What a report says of the layers of takes, and of the extremes behind them."""

from pathlib import Path

import numpy as np

from stages.files import delimited, layers, simplices

# of the weight in any mask; below this a layer has nothing to say on a frame
DEAD = 1e-3
CERTIFIED = 1e-3
REPORT = ("layer", "name", "state", "detail")


def take(folder: Path) -> dict:
    """Return the layers of a take in numbers: what they leave, and how sure they are.

    Parameters
    ----------
    folder : with layers.parquet, all of whose rows may be NaN
    """
    found = layers.read(folder / "layers.parquet")
    seen = np.isfinite(found.weights).all(axis=(1, 2))
    if not seen.any():
        return {"residual": "-", "outside": "-", "certified": "-", "shares": "no frame is solved"}
    most = found.weights[seen].max(axis=1)
    gaps = found.measures["gap"][seen]
    # the published solver proves nothing
    certified = f"{(gaps < CERTIFIED).mean():.0%}" if np.isfinite(gaps).any() else "-"
    shares = [
        f"{name} {share:.0%}"
        for name, share in zip(found.layers, (most > DEAD).mean(axis=0), strict=True)
    ]
    return {
        "residual": f"{np.median(found.measures['residual'][seen]):.4f}",
        "outside": f"{np.median(found.measures['outside'][seen]):.2f}",
        "certified": certified,
        "shares": ", ".join(shares),
    }


def extremes(folder: Path) -> str:
    """Return which extremes only one side has, or which points were left out.

    Parameters
    ----------
    folder : with simplices.tsv
    """
    rows = [row.cells for row in delimited.read(folder / "simplices.tsv", REPORT)]
    used = sum(row["state"] == simplices.USED for row in rows)
    states: dict[str, list[str]] = {}
    for row in rows:
        if row["state"] != simplices.USED:
            name = " ".join(filter(None, (row["layer"], row["name"])))
            states.setdefault(row["state"], []).append(name)
    parts = [f"{state}: {', '.join(names)}" for state, names in states.items()]
    return "; ".join([f"{used} extremes shared", *parts])
