"""Maya's script, run against a stand-in that records calls; `.anim`, read by its description."""

import re
import runpy
import sys
import types
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from played_take import PIVOT, RATES, PlayedTake
from scipy.spatial.transform import Rotation

from stages import export_maya
from stages.files import errors

TEMPLATE = Path(export_maya.__file__).parent / "templates" / "apply_in_maya.py"
# frames per second of Maya's words, after its documentation
UNITS = {"film": 24, "pal": 25, "ntsc": 30, "show": 48, "palf": 50, "ntscf": 60, "sec": 1}


def export(take):
    options = take.options("rig", "weights", script="maya.py", anim="maya.anim")
    export_maya.main([*options, "--template", str(TEMPLATE)])
    return take


class FakeCmds(types.ModuleType):
    """What the script uses of maya.cmds: a scene of one blendShape node, with linear curves."""

    def __init__(self, aliases, nodes=("faceShapes",), selected=("face",), angle="deg"):
        super().__init__("maya.cmds")
        self.aliases, self.nodes, self.selected = aliases, list(nodes), list(selected)
        self.units, self.curves, self.attributes = {"time": "film", "angle": angle}, {}, {}
        self.warnings, self.pivots = [], {}
        # Maya's spellings
        self.listHistory, self.aliasAttr, self.currentUnit = self.history, self.alias, self.unit
        self.cutKey, self.setKeyframe, self.setAttr = self.cut, self.key, self.attribute

    def ls(self, names=None, selection=False, **kind):
        if selection:
            return self.selected
        found = self.nodes if names is None else [name for name in names if name in self.nodes]
        return found if kind == {"type": "blendShape"} else []

    def history(self, names):
        return [*names, *self.nodes] if "face" in names else names

    def alias(self, node, query):
        pairs = [[alias, f"weight[{row}]"] for row, alias in enumerate(self.aliases)]
        return [word for pair in [["other", "envelope"], *pairs] for word in pair]

    def unit(self, query=False, time=None, angle=None):
        if query:
            return self.units["angle"]
        self.units["time"] = time
        return None

    def cut(self, plug, time, clear):
        keys = self.curves.setdefault(plug, {})
        self.curves[plug] = {t: v for t, v in keys.items() if not time[0] <= t <= time[1]}

    def key(self, plug, time, value, **tangents):
        assert tangents == {"inTangentType": "linear", "outTangentType": "linear"}
        self.curves[plug][time] = value

    def attribute(self, plug, value):
        self.attributes[plug] = value

    def xform(self, node, pivots, **space):
        assert space == {"objectSpace": True}
        self.pivots[node] = pivots

    def warning(self, text):
        self.warnings.append(text)

    def at(self, plug, frames):
        times = sorted(self.curves[plug])
        return np.interp(frames, times, [self.curves[plug][time] for time in times])


def run(take, cmds, monkeypatch, name="taken"):
    """Run the script as Maya would; return what it defines."""
    maya = types.ModuleType("maya")
    maya.cmds = cmds
    monkeypatch.setitem(sys.modules, "maya", maya)
    monkeypatch.setitem(sys.modules, "maya.cmds", cmds)
    return runpy.run_path(str(take.folder / "maya.py"), run_name=name)


def aliases(take):
    return [name.replace(".", "_") for name in take.played]


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_the_script_sets_every_frame_by_alias_on_the_takes_unit(tmp_path, monkeypatch, rate):
    take = export(PlayedTake(tmp_path, rate=rate, first=4, spread=2.0))
    cmds = FakeCmds(aliases(take)[::-1])
    cmds.curves["faceShapes.mouth_rom_f0003"] = {2: 7.0, 5.5: 9.0, 999: 8.0}
    run(take, cmds, monkeypatch, "__main__")
    frames = 4 + np.arange(take.count)
    for name, values in take.played.items():
        found = cmds.at(f"faceShapes.{name.replace('.', '_')}", frames)
        np.testing.assert_allclose(found, values, atol=1e-7)
    kept = cmds.curves["faceShapes.mouth_rom_f0003"]
    assert kept[2] == 7.0 and kept[999] == 8.0 and 5.5 not in kept
    assert not cmds.warnings
    word = cmds.units["time"]
    fps = UNITS.get(word) or float(word.removesuffix("fps"))
    assert fps == pytest.approx(float(rate), abs=5e-4)
    assert frames[-1] / float(rate) == pytest.approx(take.last_time)


@pytest.mark.parametrize("angle", ["deg", "rad"])
@pytest.mark.parametrize("up", ["y", "z"])
def test_the_head_and_the_targets_give_the_contract(tmp_path, monkeypatch, up, angle):
    take = export(PlayedTake(tmp_path, up))
    cmds = FakeCmds(aliases(take), angle=angle)
    made = run(take, cmds, monkeypatch)
    assert not cmds.curves
    made["apply"]("faceShapes")
    made["apply_head"]("head")
    assert cmds.attributes == {"head.rotateOrder": 0}
    pivot = np.array(cmds.pivots["head"])
    np.testing.assert_array_equal(pivot, PIVOT)
    frames = np.arange(take.count)
    channel = {
        f"{move}{axis}": cmds.at(f"head.{move}{axis}", frames)
        for move in ("translate", "rotate", "scale")
        for axis in "XYZ"
    }
    still = take.positions_without_head()
    found = []
    for frame in frames:
        shift, turns, scale = (
            np.array([channel[f"{move}{axis}"][frame] for axis in "XYZ"])
            for move in ("translate", "rotate", "scale")
        )
        turn = Rotation.from_euler("xyz", turns, degrees=angle == "deg").as_matrix()
        found.append(pivot + (scale * (still[frame] - pivot)) @ turn.T + shift)
    assert take.worst(np.array(found)) < 1e-6


def test_targets_by_the_shapes_own_name_and_those_that_lack(tmp_path, monkeypatch):
    take = export(PlayedTake(tmp_path))
    cmds = FakeCmds(["ROM_F0003", "eyes_rom_f0011", "unknown"])
    missing = run(take, cmds, monkeypatch)["apply"]()
    assert missing == ["mouth.rom_f0040", "mouth.rom_f0041", "eyes.rom_f0012"]
    assert cmds.warnings == ["faceShapes has no target for: " + ", ".join(missing)]
    assert set(cmds.curves) == {"faceShapes.ROM_F0003", "faceShapes.eyes_rom_f0011"}


@pytest.mark.parametrize(
    ("nodes", "selected"), [(["a", "b"], ["face"]), (["a"], []), ([], ["face"])]
)
def test_one_node_has_to_be_chosen(tmp_path, monkeypatch, nodes, selected):
    take = export(PlayedTake(tmp_path, count=2))
    cmds = FakeCmds(aliases(take), nodes, selected)
    wanted = "found: " + (", ".join(nodes) or "none")
    with pytest.raises(RuntimeError, match=wanted):
        run(take, cmds, monkeypatch, "__main__")


def read_anim(path):
    """Return header and curves of an .anim file, parsed by the words of its description."""
    text = path.read_text()
    head, *blocks = re.split(r"^anim ", text, flags=re.M)
    lines = [line.strip() for line in head.splitlines()]
    assert all(line.endswith(";") for line in lines)
    header = dict(line.rstrip(";").split(" ", 1) for line in lines)
    curves = {}
    for block in blocks:
        first, data = block.split(";", 1)
        full, leaf, node, row, children, _ = first.split()
        assert full == leaf and (row, children) == ("0", "0")
        found = re.fullmatch(
            r"\s*animData \{\s+input time;\s+output unitless;\s+weighted 0;"
            r"\s+preInfinity constant;\s+postInfinity constant;\s+keys \{(.*?)\}\s*\}\s*",
            data,
            re.S,
        )
        keys = [line.split() for line in found[1].strip().rstrip(";").split(";")]
        assert all(key[2:] == ["linear", "linear", "1", "1", "0"] for key in keys)
        curves[node, leaf] = np.array([[float(key[0]), float(key[1])] for key in keys])
    return header, curves


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_the_anim_file_holds_every_frame_in_its_unit(tmp_path, rate):
    take = export(PlayedTake(tmp_path, rate=rate, first=77))
    header, curves = read_anim(tmp_path / "maya.anim")
    assert header["animVersion"] == "1.1"
    unit = UNITS[header["timeUnit"]]
    ticks = rate / unit  # frames of the take in one of the file
    assert float(header["startTime"]) * ticks == pytest.approx(77)
    assert float(header["endTime"]) * ticks == pytest.approx(77 + take.count - 1)
    assert float(header["endTime"]) / unit == pytest.approx(take.last_time, abs=1e-9)
    for name, values in take.played.items():
        keys = curves["blendShape1", name.replace(".", "_")]
        frames = np.rint(keys[:, 0] * float(ticks))
        np.testing.assert_allclose(keys[:, 0] * float(ticks), frames, atol=1e-6)
        found = np.interp(77 + np.arange(take.count), frames, keys[:, 1])
        np.testing.assert_allclose(found, values, atol=1e-7)


def test_a_rate_that_maya_lacks_is_refused(tmp_path):
    take = PlayedTake(tmp_path, rate=Fraction(47), count=2)
    with pytest.raises(errors.InputError, match="47 frames/s is no time unit of Maya"):
        export(take)
    assert not list(tmp_path.glob("*maya*"))


def test_a_template_without_its_line_is_refused(tmp_path):
    take = PlayedTake(tmp_path, count=2)
    (tmp_path / "t.py").write_text("TAKE = 1\n")
    options = take.options("rig", "weights", script="maya.py", anim="maya.anim", template="t.py")
    with pytest.raises(errors.InputError, match=r"t\.py: has no line"):
        export_maya.main(options)
