"""Set a keyface take in Blender on a mesh with shape keys, by their names.

Run this in the text editor with the mesh selected, or from a script (tried in Blender 4.5)

    apply()                         shape keys and head of the active mesh
    apply(bpy.data.objects["Face"], head=False)
    apply_points("mesh.pc2")        instead: the baked points on a mesh without shape keys

The scene gets the take's rate and range. Sliders are widened where the take goes beyond 0 and 1.
A shape key is found by `<mask>.<shape>`, `<mask>_<shape>` or, where only one shape has the name, by
`<shape>`; capitals do not matter. It has to be the whole shape under its mask. Animation that these
shape keys have is replaced. The head moves on top of the transform that the mesh has when this is
run first, which is kept in the property `keyface_rest`.
"""

import json
import sys

import bpy
from mathutils import Matrix, Quaternion, Vector

TAKE = json.loads("{}")
LIMIT = 10.0  # Blender's for sliders
LINEAR = 1


def chosen():
    """Return the active object, which must be a mesh."""
    found = bpy.context.view_layer.objects.active
    if found is None or found.type != "MESH":
        raise RuntimeError("Select the mesh first")
    return found


def set_scene():
    """Give the scene the take's rate and range."""
    scene = bpy.context.scene
    fps = -(-TAKE["fps_num"] // TAKE["fps_den"])
    scene.render.fps = fps
    scene.render.fps_base = fps * TAKE["fps_den"] / TAKE["fps_num"]
    scene.frame_start, scene.frame_end = TAKE["first_frame"], TAKE["last_frame"]


def curve_of(owner, path, index=-1):
    """Return the empty curve of a property, made if it is not there."""
    data = owner.id_data
    where = owner.path_from_id(path) if owner != data else path
    owner.keyframe_insert(path, index=index, frame=TAKE["first_frame"])
    action, slot = data.animation_data.action, getattr(data.animation_data, "action_slot", None)
    # an action may hold curves of several things since Blender 4.4
    part = action if slot is None else action.layers[0].strips[0].channelbag(slot)
    curves = part.fcurves
    curve = curves.find(where, index=max(index, 0))
    curve.keyframe_points.clear()
    return curve


def set_keys(curve, keys):
    """Fill a curve with linear keys."""
    curve.keyframe_points.add(len(keys))
    curve.keyframe_points.foreach_set("co", [number for key in keys for number in key])
    curve.keyframe_points.foreach_set("interpolation", [LINEAR] * len(keys))
    curve.update()


def spellings(name):
    """Return the names under which a shape key may stand, the surest first."""
    short = name.split(".", 1)[-1].lower()
    alike = [other for other in TAKE["curves"] if other.split(".", 1)[-1].lower() == short]
    whole = [name.lower(), name.replace(".", "_").lower()]
    return [*whole, short] if len(alike) == 1 else whole


def apply(mesh=None, head=True):
    """Set the take on a mesh; return the shapes for which it has no shape key."""
    mesh = mesh or chosen()
    if mesh.data.shape_keys is None:
        raise RuntimeError(mesh.name + " has no shape keys")
    known = {key.name.lower(): key for key in mesh.data.shape_keys.key_blocks}
    set_scene()
    missing = []
    for name, keys in TAKE["curves"].items():
        key = next((known[word] for word in spellings(name) if word in known), None)
        if key is None:
            missing.append(name)
            continue
        values = [value for _, value in keys]
        key.slider_max = min(max(key.slider_max, *values, 1.0), LIMIT)
        key.slider_min = max(min(key.slider_min, *values, 0.0), -LIMIT)
        set_keys(curve_of(key, "value"), keys)
    if head:
        apply_head(mesh)
    if missing:
        sys.stdout.write(mesh.name + " has no shape key for: " + ", ".join(missing) + "\n")
    return missing


def apply_head(thing):
    """Set the head's motion on an object, on top of where it rests."""
    set_scene()
    flat = thing.get("keyface_rest")
    rest = Matrix([flat[row : row + 4] for row in (0, 4, 8, 12)]) if flat else None
    if rest is None:
        rest = thing.matrix_basis.copy()
        thing["keyface_rest"] = [value for row in rest for value in row]
    thing.rotation_mode = "QUATERNION"
    pivot, before = Vector(TAKE["pivot"]), None
    channels = {"location": [], "rotation_quaternion": [], "scale": []}
    for x, y, z, w, scale, *shift in TAKE["head"]:
        turn = Quaternion((w, x, y, z)).to_matrix().to_4x4() @ Matrix.Scale(scale, 4)
        to, back = Matrix.Translation(pivot + Vector(shift)), Matrix.Translation(-pivot)
        place, turned, size = (rest @ to @ turn @ back).decompose()
        if before is not None:
            turned.make_compatible(before)
        before = turned
        channels["location"].append(place)
        channels["rotation_quaternion"].append(turned)
        channels["scale"].append(size)
    for path, rows in channels.items():
        for index in range(len(rows[0])):
            keys = [(TAKE["first_frame"] + row, values[index]) for row, values in enumerate(rows)]
            set_keys(curve_of(thing, path, index), keys)


def apply_points(path, mesh=None):
    """Let a point cache, mesh.pc2 or mesh.mdd, move the mesh; the head moves with it."""
    mesh = mesh or chosen()
    set_scene()
    modifier = mesh.modifiers.get("keyface") or mesh.modifiers.new("keyface", "MESH_CACHE")
    modifier.cache_format = "MDD" if path.lower().endswith(".mdd") else "PC2"
    modifier.filepath = bpy.path.abspath(path)
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"
    modifier.frame_start = TAKE["first_frame"]
    return modifier


if __name__ == "__main__":
    apply()
