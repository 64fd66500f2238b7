from pathlib import Path

import numpy as np

from stages import check_rig
from stages.core import local_shapes
from stages.files import delimited, report_facts, rig

NAMES = Path(__file__).parents[2] / "stages" / "tables" / "shape_names.tsv"


def test_findings_are_a_table_and_a_line_of_the_report(tmp_path):
    neutral = np.random.default_rng(0).normal(size=(40, 3)) * [3, 6, 3]
    left = np.where(neutral[:, :1] > 0, [[0.0, -0.8, 0.1]], 0.0)
    right = np.where(neutral[:, :1] < 0, [[0.0, -0.8, 0.1]], 0.0)
    still = np.zeros((40, 3))
    character = rig.Rig(
        ["face.eyeBlink_L", "face.eyeBlink_R", "face.own"], ["face"], [], neutral,
        local_shapes.gather([right, left, still]), np.ones((1, 40)), np.zeros(3, int),
        np.zeros(0, int), np.zeros(0, int), np.zeros((0, 3)), np.zeros(3), "cm", "y", 6.0,
    )  # fmt: skip
    rig.write(tmp_path / "rig.npz", character)
    words = ["--rig", str(tmp_path / "rig.npz"), "--names", str(NAMES)]
    check_rig.main([*words, "--checks", str(tmp_path / "rig_checks.tsv")])
    rows = delimited.read(tmp_path / "rig_checks.tsv", ("check", "shape", "detail", "cure"))
    assert [(row.cells["check"], row.cells["shape"]) for row in rows] == [
        ("sides_swapped", "eyeBlink_L eyeBlink_R"),
        ("moves_nothing", "own"),
        ("names", ""),
    ]
    facts = report_facts.rig(tmp_path)
    assert facts["checks"].startswith("sides_swapped eyeBlink_L eyeBlink_R each is on the other")
    assert facts["pairs"] == "-"
