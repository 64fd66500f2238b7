"""Write meshes as binary PLY, all polygons with the same number of corners: readers differ."""

import numpy as np


def data(comment, vertices, faces, colours=None):
    """Return a mesh as the bytes of a binary PLY.

    Parameters
    ----------
    comment : str
    vertices : (V, 3) float array, written as float32
    faces : (F, N) int array, N corners each
    colours : (V, 3) float array in 0..1, written as bytes, or None
    """
    head = ["ply", "format binary_little_endian 1.0", f"comment {comment}"]
    head += [f"element vertex {len(vertices)}", *(f"property float {axis}" for axis in "xyz")]
    kinds = [("place", "<f4", (3,))]
    if colours is not None:
        head += [f"property uchar {tone}" for tone in ("red", "green", "blue")]
        kinds.append(("tone", "u1", (3,)))
    head += [f"element face {len(faces)}", "property list uchar ushort vertex_indices"]
    rows = np.zeros(len(vertices), np.dtype(kinds))
    rows["place"] = vertices
    if colours is not None:
        rows["tone"] = np.round(colours * 255)
    count = faces.shape[1]
    polygons = np.zeros(len(faces), np.dtype([("count", "u1"), ("corners", "<u2", (count,))]))
    polygons["count"], polygons["corners"] = count, faces
    return ("\n".join([*head, "end_header"]) + "\n").encode() + rows.tobytes() + polygons.tobytes()
