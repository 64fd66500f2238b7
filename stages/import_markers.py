"""Import a marker take: names, unit and axes of the show, faults found, gaps filled.

Places are in millimetres, +x the subject's left, y up, +z out of the face, with the head's motion.
`<marker>.repaired` is 0 where a marker was measured, 1 where a gap is filled, 2 where it was
mistaken for another place: replaced by an estimate, or left without a place. Nothing is repaired
silently: the table of faults has a row for every stretch.
"""

import argparse
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from stages import cli
from stages.core import clock, marker_repair
from stages.files import (
    errors,
    marker_faults_table,
    marker_file,
    marker_map,
    marker_units,
    series,
)
from stages.files.marker_faults_table import Fault


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--marker-file", required=True, help="take, .c3d, .trc or wide .csv")
    parser.add_argument(
        "--marker-map", required=True, help="table of labels and the show's names; blank: none"
    )
    parser.add_argument(
        "--unit", required=True, help="mm, cm, m, inch, or mm of one unit; file: the file's own"
    )
    parser.add_argument(
        "--axes", required=True, help="the file's axes to subject's left, up, out of face: x z -y"
    )
    parser.add_argument(
        "--rate", required=True, help="frames per second, such as 120; blank: the file's own"
    )
    parser.add_argument(
        "--max-gap-s", required=True, type=float, help="longest gap that is filled [s]"
    )
    parser.add_argument("--markers", required=True, help="markers.parquet to write")
    parser.add_argument("--faults", required=True, help="marker_faults.tsv to write")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the take, bring it to the show's names, unit and axes, repair it, write it."""
    arguments = build_parser().parse_args(argv)
    if not 0 <= arguments.max_gap_s < float("inf"):
        raise errors.InputError("--max-gap-s", f"{arguments.max_gap_s} s: give 0 or more")
    path = arguments.marker_file
    names, points, rate = _read(arguments)
    result = marker_repair.repair(points, int(arguments.max_gap_s * rate))
    faults = _faults(names, result, points)
    for fault in sorted({fault.fault for fault in faults}):
        rows = [row for row in faults if row.fault == fault]
        cells = sum(row.last_frame - row.first_frame + 1 for row in rows)
        cli.logger.info("%s: %d stretches, %d cells", fault, len(rows), cells)
    columns = series.unstack(result.points, names, "xyz")
    for place, name in enumerate(names):
        columns[f"{name}.repaired"] = result.repaired[:, place]
    measured = np.isfinite(result.points[..., 0]) & (result.repaired == marker_repair.MEASURED)
    columns["confidence"] = measured.mean(axis=1)
    frame = np.arange(len(points))
    meta = {"units": "mm", "markers": names}
    sources = [path, arguments.marker_map] if arguments.marker_map else [path]
    times = clock.frame_times(len(points), rate)
    series.write(arguments.markers, "markers", frame, times, columns, rate, meta, sources)
    marker_faults_table.write(arguments.faults, faults)


def _read(arguments: argparse.Namespace) -> tuple[list[str], np.ndarray, Fraction]:
    """Return names, points (T, P, 3) [mm] in the show's axes, and rate."""
    path = arguments.marker_file
    take = marker_file.read(path)
    for note in take.notes:
        cli.logger.info("%s: %s", path, note)
    rate = marker_units.rate(path, take, arguments.rate)
    mapped = marker_map.read(arguments.marker_map) if arguments.marker_map else {}
    kept = marker_map.apply(path, take.names, arguments.marker_map, mapped)
    cli.logger.info("%d markers, %d frames at %s Hz", len(kept), len(take.points), rate)
    if left := [name for place, name in enumerate(take.names) if place not in kept]:
        cli.logger.info("left out by the marker map: %s", ", ".join(left))
    if bare := [n for p, n in kept.items() if n != take.names[p] and n not in mapped.values()]:
        cli.logger.info("named without their subject: %d markers, such as %s", len(bare), bare[0])
    factor = marker_units.millimetres(path, arguments.unit, take.unit)
    axes = marker_units.axes(arguments.axes)
    if np.linalg.det(axes) < 0:
        cli.logger.info("axes %s: the file's are taken for left-handed", arguments.axes)
    turned = (factor * axes.T).astype(np.float32)
    points = take.points[:, list(kept)] @ turned
    if not np.isfinite(points).any():
        raise errors.InputError(path, "holds no marker that is ever seen: export it again")
    return list(kept.values()), points, rate


def _faults(names: list[str], result: marker_repair.Repaired, points: np.ndarray) -> list[Fault]:
    """Return the rows of the table of faults, by marker and frame."""
    known = np.isfinite(result.points[..., 0])
    rows = []
    for gap in result.gaps:
        cure = "filled" if known[gap.first : gap.last + 1, gap.marker].all() else "left"
        rows.append((gap.marker, gap.first, gap.last, "gap", cure))
    for fault in result.faults:
        kind = "jump" if fault.sudden else "distance"
        kind = "swap" if fault.partner >= 0 else kind
        cure = "replaced" if known[fault.first : fault.last + 1, fault.marker].all() else "left"
        rows.append((fault.marker, fault.first, fault.last, kind, cure))
    for marker in np.flatnonzero(np.isnan(points[..., 0]).all(axis=0)):
        cli.logger.info("%s is never seen: leave it out in the marker map", names[marker])
        rows.append((int(marker), 0, len(points) - 1, "missing", "left"))
    return [Fault(names[row[0]], *row[1:]) for row in sorted(rows)]


if __name__ == "__main__":
    cli.run_stage(main)
