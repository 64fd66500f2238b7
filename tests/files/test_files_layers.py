import dataclasses
from fractions import Fraction

import numpy as np
import pytest

from stages.files import errors, layers, series


def drawn(frames=7):
    rng = np.random.default_rng(0)
    extremes = [("emotion", "neutral"), ("emotion", "joy"), ("speech", "rest"), ("speech", "m")]

    def drawn_values(*shape):
        return rng.random(shape, dtype=np.float32).astype(float)

    return layers.Layers(
        np.arange(frames),
        np.arange(frames) / 25,
        Fraction(25),
        ["upper", "mouth", "eyes"],
        ["emotion", "speech"],
        extremes,
        drawn_values(frames, 3, 2),
        drawn_values(frames, 4),
        drawn_values(frames, 3),
        {name: drawn_values(frames) for name in layers.MEASURES},
        drawn_values(frames),
    )


def test_layers_come_back(tmp_path):
    path = tmp_path / "layers.parquet"
    written = drawn()
    layers.write(path, written, {"solver": "certified"}, [])
    read = dataclasses.asdict(layers.read(path))
    for name, value in dataclasses.asdict(written).items():
        np.testing.assert_equal(read[name], value)
    found = series.read(path, "layers")
    np.testing.assert_array_equal(found.columns["weight.eyes.emotion"], written.weights[:, 2, 0])
    np.testing.assert_array_equal(found.columns["coefficient.speech.m"], written.coefficients[:, 3])
    np.testing.assert_array_equal(found.columns["amplitude.mouth"], written.amplitudes[:, 1])
    assert found.meta["solver"] == "certified"


def test_a_missing_column_and_another_kind_are_named(tmp_path):
    path = tmp_path / "layers.parquet"
    layers.write(path, drawn(), {}, [])
    found = series.read(path, "layers")
    columns = {n: v for n, v in found.columns.items() if n != "weight.mouth.speech"}
    series.write(path, "layers", found.frame, found.time_s, columns, found.rate, found.meta)
    with pytest.raises(errors.InputError, match=r"column weight\.mouth\.speech is missing"):
        layers.read(path)
    series.write(path, "solved", found.frame, found.time_s, columns, found.rate, {})
    with pytest.raises(errors.InputError, match="kind 'solved', expected 'layers'"):
        layers.read(path)
