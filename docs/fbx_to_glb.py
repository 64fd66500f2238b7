"""Bring the rig of an FBX file to GLB, with Blender 4.5 or later.

    blender --background --python docs/fbx_to_glb.py -- head.fbx head.glb

Transforms of objects are applied to their meshes, so that the GLB is y up and in metres, and looks
as it does in Blender. Shape keys become morph targets; materials and animation are left out.
"""

import sys

import bpy


def main(source: str, target: str) -> None:
    """Import the one, export the other."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.fbx_import(filepath=source)
    for thing in bpy.context.scene.objects:
        thing.select_set(thing.type == "MESH")
    bpy.context.view_layer.objects.active = bpy.context.selected_objects[0]
    bpy.ops.object.parent_clear(type="CLEAR_KEEP_TRANSFORM")
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    bpy.ops.export_scene.gltf(
        filepath=target,
        export_format="GLB",
        use_selection=True,
        export_morph_normal=False,
        export_normals=False,
        export_texcoords=False,
        export_materials="NONE",
        export_animations=False,
    )


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1 :])
