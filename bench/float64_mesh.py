"""Where the vertices of a take are: the contract, written out in float64 beside the package's core.

x(v, t) = H_t [ N(v) + sum_l M_l(v) sum_i u_li(t) (B_i(v) - N(v)) ]
"""

from pathlib import Path

import numpy as np

from stages.files import rig, weights

# the face's axes (y up, looking along +z) in a file with z up, which looks along -y
TURNED = {"y": np.eye(3), "z": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])}


def rig_of(take: Path) -> Path:
    """Return the rig that a take's folder `results/takes/<shot>/<character>` was baked from.

    Raises
    ------
    FileNotFoundError
        if no actor's rig of that character has the shapes of the take's weights
    """
    header = (take / "weights.csv").open().readline().strip().split(",")
    for path in sorted(take.parents[2].glob(f"cast/*/{take.name}/rig.npz")):
        if set(rig.read_any(path).names) <= set(header):
            return path
    raise FileNotFoundError(f"{take.parents[2]}/cast/*/{take.name}/rig.npz")


def full_shapes(character: rig.Rig) -> np.ndarray:
    """Return the masked differences (K, V, 3) of all shapes."""
    found = np.zeros((len(character.names), *character.neutral.shape))
    deltas = character.deltas
    for row, mask in enumerate(character.mask_index):
        part = slice(deltas.first[row], deltas.first[row + 1])
        places = deltas.vertices[part]
        found[row, places] = character.masks[mask, places, None] * deltas.values[part]
    return found


def positions(rig_path: Path, weights_path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the times (T,) [s] and positions (T, V, 3) of a take, in the character's axes."""
    character = rig.read(rig_path, "mesh")
    played = weights.read(weights_path, character.names)
    shapes = full_shapes(character).reshape(len(character.names), -1)
    axes, pivot = TURNED[character.up_axis], character.pivot
    found = np.empty((len(played.frame), *character.neutral.shape))
    for frame, row in enumerate(played.shapes):
        points = character.neutral + (row @ shapes).reshape(-1, 3) - pivot
        x, y, z, w = played.rotation[frame] / np.linalg.norm(played.rotation[frame])
        # v + 2 w (q x v) + 2 q x (q x v), in the face's axes
        inner = points @ axes
        once = 2 * np.cross([x, y, z], inner)
        turned = inner + w * once + np.cross([x, y, z], once)
        moved = played.scale[frame] * turned + character.face_unit * played.translation[frame]
        found[frame] = pivot + moved @ axes.T
    return played.time_s, found
