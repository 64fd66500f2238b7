"""What a report says of shots and of rigs, from their files."""

import json
from pathlib import Path

import numpy as np

from stages.core import head_leak
from stages.files import (
    delimited,
    driving_points,
    marker_faults_table,
    pair_residuals,
    reference_table,
    series,
)

MOTION_2D = ("rotation.z", "translation.x", "translation.y", "scale")
MOTION_3D = tuple(f"{kind}.{axis}" for kind in ("rotation", "translation") for axis in "xyz")
DOUBTED_PAIRS = 3
CURVES, RIG = ("curve_checks.tsv", "channel"), ("rig_checks.tsv", "shape")
SHOWN = 12


def is_whole(folder: Path) -> bool:
    """Return whether a shot has points without head motion, or recorded curves."""
    points, curves = ("expression", "head_motion"), ("curves", "curve_head_motion")
    return any(
        all((folder / f"{n}.parquet").is_file() for n in names) for names in (points, curves)
    )


def shot(folder: Path) -> dict:
    """Return frames, confidence over time, lost frames, head leak, and notes on a shot."""
    if not (folder / "expression.parquet").is_file():
        return _curves(folder)
    expression = series.read(folder / "expression.parquet", "expression")
    motion = series.read(folder / "head_motion.parquet", "head_motion")
    by_markers = not expression.meta.get("points")
    name = "markers.confidence" if by_markers else "confidence"
    confidence = np.nan_to_num(expression.columns[name])
    notes = [_residuals(folder), _markers(folder), _sync(folder), _checks(folder, CURVES)]
    leak = _leak(folder, motion, "markers" if by_markers else "video")
    return _facts(confidence, leak, notes)


def _curves(folder: Path) -> dict:
    """Return the same of a shot that holds recorded curves alone."""
    curves = series.read(folder / "curves.parquet", "curves")
    return _facts(np.nan_to_num(curves.columns["confidence"]), "-", [_checks(folder, CURVES)])


def _facts(confidence: np.ndarray, leak: str, notes: list[str]) -> dict:
    """Return a shot's row of the report."""
    lost = int((confidence == 0).sum())
    return {
        "frames": len(confidence),
        "strip": _strip(confidence),
        "lost": f"{lost} ({lost / len(confidence):.0%})",
        "leak": leak,
        "notes": "; ".join(note for note in notes if note),
    }


def rig(folder: Path) -> dict:
    """Return pairs, the share of frames they do not reach, those to doubt first, and checks."""
    facts = {"pairs": "-", "uncovered": "-", "doubted": "", "checks": _checks(folder, RIG)}
    if not (folder / "references.parquet").is_file():
        return facts
    _, header = reference_table.read(folder / "references.parquet")
    uncovered, path = header["uncovered"], folder / "pair_residuals.parquet"
    doubted = []
    if path.is_file():
        for row in pair_residuals.read(path)[:DOUBTED_PAIRS]:
            pair = f"{row['animator']}'s {row['shot']} {row['frame']}"
            partner = f"{row['partner_animator']}'s {row['partner_shot']} {row['partner_frame']}"
            doubted.append(f"{pair} (off by {row['residual']:.2f}, see {partner})")
    return facts | {
        "pairs": header["pairs"],
        "uncovered": "-" if uncovered is None else f"{uncovered:.0%}",
        "doubted": "; ".join(doubted),
    }


def _strip(confidence: np.ndarray) -> str:
    """Return the SVG path of the area below a curve from 0 to 1."""
    steps = "".join(f"V{1 - value:.2f}h1" for value in confidence)
    return f"M0 1{steps}V1Z"


def _leak(folder: Path, motion: series.Series, kind: str) -> str:
    """Return the head leak, with the face's strongest motion as the opening of the jaw."""
    points = driving_points.read(folder / "expression.parquet", kind).points
    names = MOTION_3D if kind == "markers" else MOTION_2D
    parameters = np.stack([motion.columns[name] for name in names], axis=1)
    opening = head_leak.strongest_motion(points.reshape(len(points), -1))
    leak = head_leak.head_leak(parameters, opening, round(float(motion.rate)))
    return "-" if np.isnan(leak) else f"{leak:.2f}"


def _residuals(folder: Path) -> str:
    """Return how far the points lie from what the key shapes can show, by region."""
    path = folder / "key_weights.parquet"
    if not path.is_file():
        return ""
    parts = [
        f"{name.removesuffix('.residual')} {np.nanmedian(values):.4f}"
        for name, values in series.read(path, "key_weights").columns.items()
        if name.endswith(".residual") and np.isfinite(values).any()
    ]
    return f"residuals {', '.join(parts)}"


def _markers(folder: Path) -> str:
    """Return which markers were mistracked, and how many gaps there were."""
    path = folder / "marker_faults.tsv"
    if not path.is_file():
        return ""
    faults = marker_faults_table.read(path)
    gaps = [fault for fault in faults if fault.fault == "gap"]
    left = sum(fault.cure == "left" for fault in gaps)
    wrong = [fault for fault in faults if fault.fault != "gap"]
    words = [
        f"{fault.marker} {fault.fault} {fault.first_frame}-{fault.last_frame} {fault.cure}"
        for fault in wrong
    ]
    open_gaps = f" ({left} left open)" if left else ""
    return f"markers: {len(gaps)} gaps{open_gaps}" + "".join(f", {word}" for word in words)


def _checks(folder: Path, table: tuple[str, str]) -> str:
    """Return what looks wrong in recorded curves, or with a rig, the gravest first."""
    name, column = table
    if not (folder / name).is_file():
        return ""
    rows = delimited.read(folder / name, ("check", column, "detail", "cure"))
    alike: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        found = row.cells["check"], row.cells["detail"]
        alike.setdefault(found, []).append(row.cells[column])
    words = [
        " ".join(filter(None, (check, ", ".join(filter(None, own)), detail)))
        for (check, detail), own in alike.items()
    ]
    more = [f"{len(words) - SHOWN} more in {name}"] if len(words) > SHOWN else []
    return "; ".join(words[:SHOWN] + more)


def _sync(folder: Path) -> str:
    """Return where the marker system's clock stands against the film's."""
    path = folder / "sync.json"
    if not path.is_file():
        return ""
    found = json.loads(path.read_text(encoding="utf-8"))
    if found["refused"]:
        return f"sync refused: {found['reason']}"
    drift = f", drift {found['drift_ppm']:.0f} ppm" if found["drift_ppm"] else ""
    return f"markers start {found['offset_s']:+.3f} s on the film{drift}"
