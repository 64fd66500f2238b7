"""The locked key shapes of the example against those that would be chosen freely."""

import csv
from pathlib import Path

import numpy as np
import pytest

from stages.core import (
    key_shape_candidates,
    key_shape_selection,
    key_weights,
    pca,
    planar_motion,
)
from stages.files import point_set, region_settings

PROJECT = Path(__file__).parents[2]
REGIONS = {"mouth": ("lips",), "eyes": ("eye", "brow")}
NEUTRAL_FRAME = 4
STEP = 4


def expressions(shot):
    """Return the names and the true points of a shot [face units], its head motion removed."""
    truth = np.load(PROJECT / "data_example" / "truth" / f"{shot}.npz")
    rom = np.load(PROJECT / "data_example" / "truth" / "rom.npz")["landmarks"]
    names = [str(name) for name in truth["point_names"]]
    owners = [point_set.contour_of(name) for name in names]
    neutral = rom[NEUTRAL_FRAME].astype(float)
    ends = [neutral[[o == side for o in owners]].mean(axis=0) for side in ("eye_right", "eye_left")]
    unit = np.linalg.norm(ends[1] - ends[0])
    points, neutral = ((p - np.mean(ends, axis=0)) / unit for p in (truth["landmarks"], neutral))
    votes = np.array([1 / owners.count(owner) for owner in owners])
    deviation = planar_motion.clip_deviation(points, neutral, votes, 0)
    return (
        names,
        planar_motion.remove(points, *planar_motion.fit(points, neutral, deviation)),
        neutral,
    )


@pytest.fixture(scope="module")
def shots():
    return {shot: expressions(shot) for shot in ("rom", "talk")}


@pytest.mark.parametrize("region", REGIONS)
def test_a_free_choice_is_as_good_as_the_locked_key_shapes(shots, region):
    names, rom, neutral = shots["rom"]
    _, talk, _ = shots["talk"]
    chosen = [name.startswith(REGIONS[region]) for name in names]
    rom, talk = (points[:, chosen].reshape(len(points), -1) for points in (rom, talk))
    neutral = neutral[chosen].ravel()
    with (PROJECT / "config" / "key_shapes.tsv").open() as stream:
        rows = [row for row in csv.DictReader(stream, delimiter="\t") if row["region"] == region]
    locked = [int(row["frame"]) for row in rows]
    seen = rom[::STEP]
    free = key_shape_selection.choose(
        key_shape_candidates.Candidates(seen, neutral, pca.fit(seen), np.ones(len(seen), bool)),
        len(locked),
        region_settings.DEFAULTS["method"],
    )
    errors = [
        _rms(talk[::STEP], shapes, neutral)
        for shapes in (seen[[choice.frame for choice in free]], rom[locked])
    ]
    assert errors[0] <= 1.05 * errors[1]
    assert errors[0] < 0.5 * np.sqrt(np.mean((talk - neutral) ** 2))


def _rms(frames, shapes, neutral):
    """Return the root mean square residual of the default solve."""
    sigma = float(region_settings.DEFAULTS["sigma"])
    solve = region_settings.DEFAULTS["solve"]
    weights = key_weights.solve(frames, shapes, neutral, solve, sigma, None).weights
    return np.sqrt(np.mean((frames - neutral - weights @ (shapes - neutral)) ** 2))
