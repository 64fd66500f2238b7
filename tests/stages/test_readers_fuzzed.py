"""Files that are cut short or changed: a take or one line, in bounded memory.

C3D, GLB and the rig's own file have such tests beside their readers.
"""

import os
import struct
import tracemalloc
import warnings

import numpy as np
import other_trackers
import pytest
import recorded_curves
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stages.files import (
    curve_file,
    edits,
    errors,
    landmark_file,
    marker_file,
    mesh,
    mouth_cues,
    series,
    text_grid,
    word_times,
)

MOST_BYTES = 64 * 2**20
# KEYFACE_FUZZ asks for more of them
EXAMPLES = int(os.environ.get("KEYFACE_FUZZ", "20"))
HOSTILE = [
    *(b"99999999999999", b"4000000000", b"-1", b"1e308", b"nan", b"inf", b"0x1", b"1_0"),
    *(b'"', b'""', b"\t", b",", b";", b"\r", b"\n", b"\x00", b"\xff\xfe", b"\xef\xbb\xbf"),
    *(b"{", b"}", b"[", b"]", b"null", b"[" * 3000, b"\xc3", "\u0663".encode(), b" " * 400),
]
GRID = """File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0
xmax = 1
tiers? <exists>
size = 1
item []:
    item [1]:
        class = "IntervalTier"
        name = "phones"
        xmin = 0
        xmax = 1
        intervals: size = 2
        intervals [1]:
            xmin = 0
            xmax = 0.5
            text = "AA1"
        intervals [2]:
            xmin = 0.5
            xmax = 1
            text = ""
"""
OBJ = "v 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\nf -3 -2 -1\n"
PLY = """ply
format {} 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
"""
CUES = '{"metadata":{"soundFile":"a","duration":1.0},"mouthCues":[{"start":0,"end":1,"value":"A"}]}'
XML = (
    "<rhubarbResult><metadata><duration>1.0</duration></metadata><mouthCues>"
    '<mouthCue start="0.00" end="1.00">A</mouthCue></mouthCues></rhubarbResult>'
)
TRC = (
    "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\t"
    "OrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n60\t60\t2\t1\tmm\t60\t1\t2\n"
    "Frame#\tTime\ta\t\t\n\t\tX1\tY1\tZ1\n\n1\t0.0\t1\t2\t3\n2\t0.01667\t1\t2\t3\n"
)


def text(name, content):
    def write(folder):
        path = folder / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


def binary_ply():
    head = PLY.format("binary_little_endian").encode()
    return head + np.arange(9, dtype="<f4").tobytes() + struct.pack("<B3i", 3, 0, 1, 2)


def parquet(folder):
    path = folder / "a.parquet"
    columns = {"a.x": np.arange(4.0), "a.y": np.arange(4.0)}
    series.write(path, "tracked", np.arange(4), np.arange(4) / 25, columns, 25, {})
    return path


def landmarks(writer):
    return lambda folder: writer(other_trackers.Take(2, lost=(1,)), folder)


def curves(writer):
    return lambda folder: writer(recorded_curves.Take(4), folder)


def read_curves(path):
    curve_file.read(path, recorded_curves.SHAPES)


def read_edits(path):
    edits.lay_over(path, np.arange(3), {"face.jawOpen": np.zeros(3)})


def read_series(path):
    series.read(path, "tracked")


CASES = {
    **{
        f"landmarks {writer.__name__}": (landmarks(writer), landmark_file.read)
        for writer in other_trackers.WRITERS
        if writer is not other_trackers.ibug
    },
    **{
        f"curves {writer.__name__}": (curves(writer), read_curves)
        for writer in recorded_curves.WRITERS
    },
    "trc": (text("a.trc", TRC), marker_file.read),
    "markers csv": (text("a.csv", "frame,a_x,a_y,a_z\n1,2,3,4\n2,3,4,5\n"), marker_file.read),
    "obj": (text("a.obj", OBJ), mesh.read),
    "ply": (text("a.ply", PLY.format("ascii") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), mesh.read),
    "binary ply": (text("a.ply", binary_ply()), mesh.read),
    "text grid": (text("a.TextGrid", GRID), text_grid.read),
    "cues tsv": (text("a.tsv", "0.00\tX\n0.50\tA\n1.00\tX\n"), mouth_cues.read),
    "cues json": (text("a.json", CUES), mouth_cues.read),
    "cues xml": (text("a.xml", XML), mouth_cues.read),
    "words": (text("a.align", "0 5000 sil\n5000 9000 bin\n"), word_times.read),
    "edits": (text("a.csv", "frame,time_s,face.jawOpen\n0,0,0.5\n2,1,0.25\n"), read_edits),
    "parquet": (parquet, read_series),
}


def pts_folder(folder):
    return other_trackers.ibug(other_trackers.Take(2, lost=()), folder)


def damaged(data, whole):
    """Cut a file short, or overwrite or push in bytes at up to four places."""
    if data.draw(st.booleans()):
        return whole[: data.draw(st.integers(0, len(whole) - 1))]
    for _ in range(data.draw(st.integers(1, 4))):
        # half of the places are in the head, where the promises stand
        most = len(whole) - 1
        place = data.draw(st.integers(0, min(most, 300)) | st.integers(0, most))
        other = data.draw(st.sampled_from(HOSTILE) | st.binary(min_size=1, max_size=1))
        over = data.draw(st.booleans()) * len(other)
        whole = whole[:place] + other + whole[place + over :]
    return whole


def read_or_refused(read, path):
    """Read what may be damaged; only one line of refusal, and little memory, is right."""
    tracemalloc.start()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            read(path)
    except errors.InputError as error:
        assert "\n" not in str(error) and str(error).startswith(str(path))
    finally:
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert peak < MOST_BYTES


@pytest.mark.parametrize("case", CASES)
def test_damage_is_read_or_refused(tmp_path, case):
    write, read = CASES[case]
    path = write(tmp_path)
    whole = path.read_bytes()
    read(path)

    @settings(max_examples=EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck))
    @given(data=st.data())
    def check(data):
        path.write_bytes(damaged(data, whole))
        read_or_refused(read, path)

    check()


@settings(max_examples=EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_a_damaged_file_of_a_folder_of_pts(tmp_path_factory, data):
    folder = pts_folder(tmp_path_factory.mktemp("pts"))
    path = data.draw(st.sampled_from(sorted(folder.iterdir())))
    path.write_bytes(damaged(data, path.read_bytes()))
    read_or_refused(landmark_file.read, folder)
