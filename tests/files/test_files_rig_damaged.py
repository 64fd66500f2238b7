"""A rig that is damaged, or of another version, is refused with one line."""

import json

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stages.core import local_shapes
from stages.files import errors, model, rig


def write(path):
    made = rig.Rig(
        names=["face.a"],
        mask_names=["face"],
        controls=[],
        neutral=np.zeros((40, 3)),
        deltas=local_shapes.gather(np.random.default_rng(0).normal(size=(1, 40, 3))),
        masks=np.ones((1, 40)),
        mask_index=np.zeros(1, int),
        sizes=np.zeros(0, np.int32),
        corners=np.zeros(0, np.int32),
        colours=np.zeros((0, 3)),
        pivot=np.zeros(3),
        unit="cm",
        up_axis="y",
        face_unit=6.0,
    )
    rig.write(path, made)
    return path


@pytest.mark.parametrize("name", ["first", "corners", "face_unit"])
def test_a_rig_without_a_part_is_named(tmp_path, name):
    arrays, header = model.read(write(tmp_path / "rig.npz"), "rig")
    arrays.pop(name, None)
    header.pop(name, None)
    kept = {key: value for key, value in header.items() if key not in ("kind", "sources")}
    model.write(tmp_path / "less.npz", "rig", arrays, json.loads(json.dumps(kept)))
    with pytest.raises(errors.InputError, match=rf"less\.npz: holds no {name}"):
        rig.read_any(tmp_path / "less.npz")


@settings(
    deadline=None, max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.data())
def test_bytes_that_changed_are_refused_or_do_no_harm(tmp_path, data):
    path = write(tmp_path / "rig.npz")
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 6))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(content[: data.draw(st.integers(1, len(content)))])
    try:
        rig.read_any(path)
    except errors.InputError as error:
        assert "rig.npz" in str(error)
