"""Head motion on a character: scaled turn about its pivot, then a shift in its face units.

    H_t(x) = pivot + s R (x - pivot) + face_unit * t

Head motion is solved in the axes of a face that looks along +z with y up. A character's file may
have z up (it then looks along -y): rotation and shift are turned into its axes first.
"""

import numpy as np

# columns: where the face's x (the subject's left), y (up) and z (out of the face) point
FACE_AXES = {
    "y": np.eye(3),
    "z": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
}


def face_axes(up_axis: str) -> np.ndarray:
    """Return the (3, 3) rotation from the face's axes to a character's with `y` or `z` up."""
    if up_axis not in FACE_AXES:
        raise ValueError(f"up axis '{up_axis}' is none of {', '.join(FACE_AXES)}")
    return FACE_AXES[up_axis]


def rotation_matrix(quaternion: np.ndarray) -> np.ndarray:
    """Return the (3, 3) rotation of a quaternion (x, y, z, w), whatever its length.

    Raises
    ------
    ValueError
        if the quaternion is zero or not of four numbers
    """
    length = np.linalg.norm(quaternion)
    if np.shape(quaternion) != (4,) or not length > 0:
        raise ValueError(f"{quaternion} is no rotation")
    x, y, z, w = np.asarray(quaternion, float) / length
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def turned_quaternions(quaternions: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Express rotations in other axes: the quaternion's vector part turns with them.

    Parameters
    ----------
    quaternions : (T, 4) float array, x, y, z, w in the face's axes
    axes : (3, 3) rotation from the face's axes to the character's

    Returns
    -------
    (T, 4) float array, of length one
    """
    unit = quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)
    return np.concatenate([unit[:, :3] @ axes.T, unit[:, 3:]], axis=1)


def apply(
    vertices: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    scale: float,
    pivot: np.ndarray,
) -> np.ndarray:
    """Move the vertices of one frame with the head.

    Parameters
    ----------
    vertices : (V, 3) float array [character's unit]
    rotation : (3, 3) float array, in the character's axes
    translation : (3,) float array, in the character's axes [character's unit]
    scale : factor
    pivot : (3,) float array, the point about which the head turns [character's unit]

    Returns
    -------
    (V, 3) float array [character's unit]
    """
    return (vertices - pivot) @ (scale * rotation).T + (pivot + translation)
