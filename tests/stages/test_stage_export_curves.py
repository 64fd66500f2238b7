"""Keys that people edit, read back with `csv` and played on the character's vertices."""

import csv
import json
from fractions import Fraction

import numpy as np
import pytest
from played_take import PlayedTake

from stages import export_curves
from stages.files import errors


def export(take, tolerance="0.001"):
    command = take.options("rig", "weights", key_table="keys.csv", error="keys.json")
    export_curves.main([*command, "--tolerance", tolerance])
    with (take.folder / "keys.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    keys = {}
    for row in rows:
        keys.setdefault(row["channel"], []).append((int(row["frame"]), float(row["value"])))
    return keys, json.loads((take.folder / "keys.json").read_text())


def played(take, keys, times):
    """Return the vertices (T, V, 3) that linear keys give, without the head."""
    size = take.positions_without_head().shape[1:]
    moved = np.zeros((len(times), *size)) + take.neutral
    ramp = np.clip((take.heights + 0.2) / 0.5, 0, 1)
    masks = {"mouth": 1 - ramp, "eyes": ramp}
    for channel, points in keys.items():
        region, name = channel.split(".")
        weights = np.interp(times, *np.array(points).T)
        delta = masks[region][:, None] * take.deltas[region, name]
        moved += weights[:, None, None] * delta
    return moved


@pytest.mark.parametrize("tolerance", ["0.0005", "0.01"])
def test_the_keys_play_the_take_within_the_tolerance(tmp_path, tolerance):
    take = PlayedTake(tmp_path, rate=Fraction(30000, 1001), first=12, count=70)
    keys, told = export(take, tolerance)
    frames = 12 + np.arange(70)
    away = np.linalg.norm(played(take, keys, frames) - take.positions_without_head(), axis=2).max()
    size = np.linalg.norm(np.ptp(take.neutral, axis=0))
    assert away / size <= float(tolerance) + 1e-7
    assert told["worst_error_share"] <= float(tolerance)
    assert told["worst_error"] == pytest.approx(away, abs=1e-6 * size)
    assert told["size"] == pytest.approx(size)


def test_the_description_counts_keys_and_says_rate_and_frames(tmp_path):
    take = PlayedTake(tmp_path, rate=Fraction(30000, 1001), first=12, count=70)
    keys, told = export(take)
    assert told["keys_of_channels"] == {name: len(rows) for name, rows in keys.items()}
    assert told["keys"] == sum(map(len, keys.values())) < 70 * len(keys)
    assert told["keys_per_second"] == pytest.approx(told["keys"] / (70 * 1001 / 30000))
    assert (told["fps_num"], told["fps_den"]) == (30000, 1001)
    assert (told["first_frame"], told["last_frame"]) == (12, 81)
    for name, rows in keys.items():
        frames = [frame for frame, _ in rows]
        assert frames == sorted(set(frames))
        assert (frames[0], frames[-1]) == (12, 81)
        for frame, value in rows:
            assert value == take.played[name][frame - 12]


def test_bytes_are_the_same_again(tmp_path):
    take = PlayedTake(tmp_path)
    files = [tmp_path / "keys.csv", tmp_path / "keys.json"]
    export(take)
    before = [path.read_bytes() for path in files]
    export(take)
    assert before == [path.read_bytes() for path in files]


@pytest.mark.parametrize("tolerance", ["0", "-0.1", "nan", "1"])
def test_a_tolerance_that_is_no_share_is_refused(tmp_path, tolerance):
    take = PlayedTake(tmp_path, count=3)
    with pytest.raises(errors.InputError, match="is no share of the size"):
        export(take, tolerance)
    assert not list(tmp_path.glob("keys*"))
