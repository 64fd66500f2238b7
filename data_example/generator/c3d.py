"""Write markers as C3D with whole numbers, half the size of one with floats.

ezc3d writes the file with floats; its frames are then written again as 16-bit multiples of a step,
as the format provides: a positive POINT:SCALE.
"""

import pathlib
import struct
import tempfile

import ezc3d
import numpy as np

BLOCK = 512


def write(path, names, points, rate, step, description):
    """Write markers.

    Parameters
    ----------
    path : pathlib.Path
    names : list of str
    points : (T, P, 3) float array [mm], NaN where a marker is missing
    rate : float [Hz]
    step : float, unit of the coordinates in the file [mm]
    description : str, said of every marker
    """
    file = ezc3d.c3d()
    parameters = file["parameters"]["POINT"]
    parameters["RATE"]["value"] = [float(rate)]
    parameters["UNITS"]["value"] = ["mm"]
    parameters["LABELS"]["value"] = list(names)
    parameters["DESCRIPTIONS"]["value"] = [description] * len(names)
    parameters["SCALE"]["value"] = [-step]
    file["header"]["points"]["frame_rate"] = float(rate)
    data = np.ones((4, len(names), len(points)))
    data[:3] = np.nan_to_num(points).transpose(2, 1, 0)
    file["data"]["points"] = data
    with tempfile.TemporaryDirectory() as folder:
        whole = pathlib.Path(folder) / "markers.c3d"
        file.write(str(whole))
        head = bytearray(whole.read_bytes())
    start = BLOCK * (struct.unpack_from("<H", head, 16)[0] - 1)
    del head[start:]
    struct.pack_into("<f", head, 12, step)
    # name, then type, number of dimensions, and the value
    place = head.index(b"SCALE") + len(b"SCALE") + 4
    struct.pack_into("<f", head, place, step)
    path.write_bytes(bytes(head) + _frames(points, step))


def _frames(points, step):
    """Return the bytes of the frames; the fourth word is the residual, -1 where missing."""
    missing = np.isnan(points).any(axis=2)
    words = np.zeros((*missing.shape, 4), np.int16)
    words[..., :3] = np.where(missing[..., None], 0, np.round(np.nan_to_num(points) / step))
    words[..., 3] = np.where(missing, -1, 1)
    body = words.astype("<i2").tobytes()
    return body + bytes(-len(body) % BLOCK)
