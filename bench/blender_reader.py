"""Import a take's files into Blender and save where its vertices are at every frame.

Run by Blender's Python, with nothing of the package: `python blender_reader.py FOLDER`. The folder
holds the files and `character.npz` (neutral, sizes, corners, shapes, names, up, metres); it gets
`blender_<format>.npz` with `frames`, `times` and `positions`, in the character's axes and unit.
"""

import json
import runpy
import sys
from pathlib import Path

import bpy
import numpy as np

# from Blender's z up to a file's own axes
BACK = {"y": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]), "z": np.eye(3)}


def fresh(said):
    """Empty the scene, give it the rate and the range of the take."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    fps = -(-said["fps_num"] // said["fps_den"])
    scene.render.fps, scene.render.fps_base = fps, fps * said["fps_den"] / said["fps_num"]


def the_mesh():
    """Return the only mesh of the scene."""
    (found,) = [thing for thing in bpy.data.objects if thing.type == "MESH"]
    return found


def coordinates(mesh):
    """Return the evaluated vertices (V, 3) in the world."""
    graph = bpy.context.evaluated_depsgraph_get()
    evaluated = mesh.evaluated_get(graph)
    data = evaluated.to_mesh()
    flat = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", flat)
    matrix = np.array(evaluated.matrix_world, float)
    evaluated.to_mesh_clear()
    return flat.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]


def play(mesh, frames):
    """Return the coordinates at every frame (T, V, 3)."""
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
        found.append(coordinates(mesh))
    return np.array(found)


def seconds(frames):
    """Return the times of frames at the scene's rate [s]."""
    render = bpy.context.scene.render
    return np.array(frames) * render.fps_base / render.fps


def keyed():
    """Return the places of the keys of all animation in the file, in frames."""
    curves = [curve for action in bpy.data.actions for curve in action.fcurves]
    return sorted({point.co[0] for curve in curves for point in curve.keyframe_points})


def upright(character):
    """Return what brings Blender's world to the character's axes and unit."""
    return BACK[str(character["up"])] / float(character["metres"])


def glb(folder, character):
    """Import the glTF.

    Blender's importer takes the scene's rate for a whole one: at 24000/1001 its keys would stand
    beside the frames. So the scene plays at the whole rate, and times are those of its keys.
    """
    bpy.context.scene.render.fps_base = 1.0
    bpy.ops.import_scene.gltf(filepath=str(folder / "mesh.glb"))
    frames = keyed()
    return frames, play(the_mesh(), frames) @ upright(character).T


def usd(folder, character, name="mesh.usdc"):
    """Import USD; the scene's range is the file's."""
    bpy.ops.wm.usd_import(filepath=str(folder / name))
    scene = bpy.context.scene
    frames = range(scene.frame_start, scene.frame_end + 1)
    return frames, play(the_mesh(), frames) @ upright(character).T


def points(folder, character):
    """Import point samples."""
    return usd(folder, character, "points.usdc")


def build(character, shapes):
    """Make the character's mesh, with its shapes as shape keys if asked for."""
    ends = np.cumsum(character["sizes"])
    corners = character["corners"].tolist()
    faces = [corners[end - size : end] for end, size in zip(ends, character["sizes"], strict=True)]
    data = bpy.data.meshes.new("face")
    data.from_pydata(character["neutral"].tolist(), [], faces)
    made = bpy.data.objects.new("face", data)
    bpy.context.scene.collection.objects.link(made)
    bpy.context.view_layer.objects.active = made
    if shapes:
        made.shape_key_add(name="Basis")
        for name, moved in zip(character["names"], character["shapes"], strict=True):
            key = made.shape_key_add(name=str(name), from_mix=False)
            key.data.foreach_set("co", (character["neutral"] + moved).astype(np.float32).ravel())
    return made


def script(folder, character):
    """Run the take's own script on a mesh with shape keys."""
    mesh = build(character, shapes=True)
    runpy.run_path(str(folder / "blender.py"), run_name="__main__")
    scene = bpy.context.scene
    frames = range(scene.frame_start, scene.frame_end + 1)
    return frames, play(mesh, frames)


def cache(folder, character, name):
    """Let a point cache move the mesh, by the take's own script."""
    mesh = build(character, shapes=False)
    taken = runpy.run_path(str(folder / "blender.py"))
    taken["apply_points"](str(folder / name))
    scene = bpy.context.scene
    frames = range(scene.frame_start, scene.frame_end + 1)
    return frames, play(mesh, frames)


def pc2(folder, character):
    """Play the PC2 cache."""
    return cache(folder, character, "mesh.pc2")


def mdd(folder, character):
    """Play the MDD cache."""
    return cache(folder, character, "mesh.mdd")


def obj(folder, _character):
    """Import every OBJ as it stands."""
    found, frames = [], []
    for path in sorted((folder / "obj").glob("*.obj")):
        bpy.ops.wm.obj_import(filepath=str(path), forward_axis="Y", up_axis="Z")
        mesh = the_mesh()
        found.append(coordinates(mesh))
        frames.append(int(path.stem.split("_")[1]))
        data = mesh.data
        bpy.data.objects.remove(mesh)
        bpy.data.meshes.remove(data)
    return frames, np.array(found)


def main():
    """Import every format, each into an empty scene."""
    folder = Path(sys.argv[-1])
    said = json.loads((folder / "mesh.json").read_text())
    character = np.load(folder / "character.npz")
    for read in (glb, usd, points, pc2, mdd, obj, script):
        fresh(said)
        try:
            frames, found = read(folder, character)
        except (RuntimeError, ValueError) as error:
            sys.stdout.write(f"blender {read.__name__}: {error}\n")
            continue
        path = folder / f"blender_{read.__name__}.npz"
        np.savez(path, frames=np.array(frames), times=seconds(frames), positions=found)


if __name__ == "__main__":
    main()
