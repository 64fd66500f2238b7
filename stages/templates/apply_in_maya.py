"""Set the keys of a keyface take in Maya, by the names of a blendShape node's targets.

Run this in the script editor with the node, or the mesh that it deforms, selected; or

    apply("blendShape1")            the node by its name
    apply_head("head")              a transform above the mesh, if the head is to move

Maya's time unit becomes that of the take (keys that are there keep their seconds), keys between
its first and last frame are replaced. A target is found by `<mask>_<shape>` or, where only one
shape has the name, by `<shape>`; capitals do not matter. A target has to be the whole shape under
its mask. `apply_head` expects a transform that rests at the origin, and moves by the character's
own unit and axes. Checked against a stand-in for maya.cmds only, never in Maya.
"""

import json
import math

from maya import cmds

TAKE = json.loads("{}")


def chosen():
    """Return the one blendShape node that is selected, or that deforms what is."""
    selected = cmds.ls(selection=True) or []
    history = (cmds.listHistory(selected) or []) if selected else []
    nodes = sorted(set(cmds.ls(selected + history, type="blendShape") or [])) if selected else []
    if len(nodes) != 1:
        found = ", ".join(nodes or cmds.ls(type="blendShape") or []) or "none"
        raise RuntimeError("Select one blendShape node or its mesh; found: " + found)
    return nodes[0]


def targets(node):
    """Return the targets' aliases by their names without capitals."""
    pairs = cmds.aliasAttr(node, query=True) or []
    weights = [row for row in range(0, len(pairs), 2) if pairs[row + 1].startswith("weight[")]
    return {pairs[row].lower(): pairs[row] for row in weights}


def spellings(name):
    """Return the names under which a target may stand, the surest first."""
    whole = name.replace(".", "_").lower()
    short = name.split(".", 1)[-1].lower()
    alike = [other for other in TAKE["curves"] if other.split(".", 1)[-1].lower() == short]
    return [whole, short] if len(alike) == 1 else [whole]


def set_keys(plug, keys, factor=1.0):
    """Replace the keys of an attribute within the take."""
    cmds.cutKey(plug, time=(TAKE["first_frame"], TAKE["last_frame"]), clear=True)
    for frame, value in keys:
        cmds.setKeyframe(
            plug,
            time=frame,
            value=factor * value,
            inTangentType="linear",
            outTangentType="linear",
        )


def apply(node=None):
    """Set the keys of all targets; return the shapes for which the node has none."""
    node = node or chosen()
    known, missing = targets(node), []
    cmds.currentUnit(time=TAKE["time_unit"])
    for name, keys in TAKE["curves"].items():
        alias = next((known[word] for word in spellings(name) if word in known), None)
        if alias is None:
            missing.append(name)
        else:
            set_keys(node + "." + alias, keys)
    if missing:
        cmds.warning(node + " has no target for: " + ", ".join(missing))
    return missing


def apply_head(transform):
    """Set the head's motion on a transform that rests at the origin."""
    cmds.currentUnit(time=TAKE["time_unit"])
    cmds.setAttr(transform + ".rotateOrder", 0)
    cmds.xform(transform, objectSpace=True, pivots=TAKE["pivot"])
    radians = cmds.currentUnit(query=True, angle=True) in ("rad", "radian")
    for channel, keys in TAKE["head"].items():
        turned = radians and channel.startswith("rotate")
        set_keys(transform + "." + channel, keys, math.pi / 180 if turned else 1.0)


if __name__ == "__main__":
    apply()
