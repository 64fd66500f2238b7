"""Write the tortoise: neutral, painted masks and one mesh for each extreme, as binary PLY."""

import numpy as np

from data_example.generator import ply_writer, tortoise, tortoise_poses, tortoise_rig

COMMENT = "tortoise"


def painted(masks):
    """Return the masks as colours in whole bytes that sum to 255 at every vertex, (V, 3) in 0..1.

    Parameters
    ----------
    masks : (3, V) float array, a partition of unity
    """
    whole = np.floor(masks.T * 255 + 1e-9)
    left = masks.T * 255 - whole
    # what rounding down has left goes to where it took the most
    order = np.argsort(np.argsort(-left, axis=1, kind="stable"), axis=1, kind="stable")
    return (whole + (order < np.round(left.sum(axis=1))[:, None])) / 255


def write_all(folder):
    """Write the tortoise into its folder."""
    character = tortoise_rig.build()
    (folder / "poses").mkdir(parents=True, exist_ok=True)
    neutral = character.pose(tortoise.pose_of())
    for name, colours in (("neutral", character.colours), ("masks", painted(character.masks))):
        mesh = ply_writer.data(COMMENT, neutral, character.faces, colours)
        (folder / f"{name}.ply").write_bytes(mesh)
    for name, pose in tortoise_poses.all_poses().items():
        mesh = ply_writer.data(COMMENT, character.pose(pose), character.faces)
        (folder / "poses" / f"{name}.ply").write_bytes(mesh)
