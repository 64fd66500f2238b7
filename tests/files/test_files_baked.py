"""EXR, JSON, PC2 and films, read back by readers that are not ours."""

import struct
from fractions import Fraction

import av
import numpy as np
import OpenEXR
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.files import errors, exr, film_writer, pc2


def write_exr(folder, points, max_width=exr.MAX_WIDTH, first_frame=0):
    frames, vertices, _ = points.shape
    with exr.writer(folder / "m.exr", vertices, frames, max_width) as append:
        for frame in points:
            append(frame)
    bounds = np.stack([points.min(axis=(0, 1)), points.max(axis=(0, 1))])
    exr.write_json(
        folder / "m.json",
        vertices,
        frames,
        first_frame,
        Fraction(30000, 1001),
        bounds,
        {"unit": "cm"},
        max_width,
    )
    return exr.read_json(folder / "m.json")


@settings(deadline=None, max_examples=30)
@given(st.integers(1, 40), st.integers(1, 70), st.integers(1, 20), st.integers(0, 2**32 - 1))
def test_row_is_frame_times_blocks_plus_block(tmp_path_factory, vertices, frames, width, seed):
    folder = tmp_path_factory.mktemp("exr")
    points = np.random.default_rng(seed).normal(size=(frames, vertices, 3)).astype(np.float32)
    layout = write_exr(folder, points, width)
    with OpenEXR.File(str(folder / "m.exr"), separate_channels=True) as file:
        planes = [file.channels()[name].pixels for name in "RGB"]
    assert all(plane.dtype == np.float32 for plane in planes)
    blocks = layout["blocks"]
    assert planes[0].shape == (frames * blocks, layout["width"])
    assert layout["width"] <= width
    for vertex in range(vertices):
        block, column = divmod(vertex, layout["width"])
        for axis in range(3):
            np.testing.assert_array_equal(
                planes[axis][block::blocks, column], points[:, vertex, axis]
            )
    low, high = layout["bounds"]["min"], layout["bounds"]["max"]
    np.testing.assert_array_equal([plane.min() for plane in planes], low)
    np.testing.assert_array_equal([plane.max() for plane in planes], high)
    reader = exr.Reader(folder / "m.exr", layout)
    for frame in (0, frames - 1, frames // 2, 0):
        np.testing.assert_array_equal(reader.frame(frame), points[frame])


def test_more_than_8192_vertices_are_wrapped_evenly():
    assert exr.layout(8192) == (8192, 1)
    assert exr.layout(8193) == (4097, 2)
    assert exr.layout(26719) == (6680, 4)


def test_json_states_rate_bounds_and_rounding(tmp_path):
    points = np.random.default_rng(0).normal(size=(3, 5, 3)).astype(np.float32) * 170
    layout = write_exr(tmp_path, points, first_frame=12)
    assert (layout["fps_num"], layout["fps_den"], layout["first_frame"]) == (30000, 1001, 12)
    rounding = np.abs(points).max() * 2.0**-24
    assert layout["quantisation"] == {"type": "float32", "max_error": pytest.approx(rounding)}
    reader = exr.Reader(tmp_path / "m.exr", layout)
    assert [reader.nearest(frame * 1001 / 30000) for frame in (0, 12, 13, 14, 99)] == [
        0,
        0,
        1,
        2,
        2,
    ]
    layout["width"] = 4
    with pytest.raises(errors.InputError, match="5 x 3 in place of what its JSON says"):
        exr.Reader(tmp_path / "m.exr", layout)
    (tmp_path / "m.json").write_text('{"layout_version": 9}')
    with pytest.raises(errors.InputError, match="layout version 9 in place of 1"):
        exr.read_json(tmp_path / "m.json")


def test_pc2_is_what_its_specification_says(tmp_path):
    points = np.random.default_rng(0).normal(size=(4, 6, 3)).astype(np.float32)
    with pc2.writer(tmp_path / "m.pc2", 6, 4, 7) as append:
        for frame in points:
            append(frame.astype(float))
    data = (tmp_path / "m.pc2").read_bytes()
    assert struct.unpack("<12siiffi", data[:32]) == (b"POINTCACHE2\0", 1, 6, 7.0, 1.0, 4)
    np.testing.assert_array_equal(np.frombuffer(data[32:], "<f4").reshape(4, 6, 3), points)


HEARD = 48000


def sounding_film(path, late=0.0, count=60, sound=True):
    """Flash one picture each second and beep as it begins; the sound may start late."""
    with av.open(str(path), "w") as container:
        video = container.add_stream("libx264", rate=30, options={"preset": "ultrafast"})
        video.width, video.height, video.pix_fmt = 64, 48, "yuv420p"
        if sound:
            audio = container.add_stream("aac", rate=HEARD, layout="mono")
        for number in range(count):
            picture = np.full((48, 64, 3), 255 if number % 30 == 15 else 20, np.uint8)
            frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
            frame.pts = number
            container.mux(video.encode(frame))
        container.mux(video.encode())
        if sound:
            times = late + np.arange(int((count / 30 - late) * HEARD)) / HEARD
            beeps = np.where((times % 1.0 >= 0.5) & (times % 1.0 < 0.55), np.sin(1e4 * times), 0.0)
            frame = av.AudioFrame.from_ndarray(beeps[None].astype(np.float32), "fltp", "mono")
            frame.sample_rate, frame.pts = HEARD, round(late * HEARD)
            frame.time_base = Fraction(1, HEARD)
            container.mux(audio.encode(frame))
            container.mux(audio.encode())
    return path


def flashes_and_beeps(path):
    with av.open(str(path)) as container:
        flashes = [
            f.time for f in container.decode(video=0) if f.to_ndarray(format="gray").mean() > 128
        ]
    with av.open(str(path)) as container:
        frames = list(container.decode(audio=0))
    heard = np.concatenate([frame.to_ndarray()[0] for frame in frames])
    loud = np.flatnonzero(np.abs(heard) > 0.3)
    starts = loud[np.diff(loud, prepend=-HEARD) > HEARD // 4]
    return flashes, frames[0].time + starts / HEARD


@pytest.mark.parametrize("late", [0.0, 0.25])
@pytest.mark.parametrize("start", [0.0, 0.2])
def test_sound_stays_with_the_picture(tmp_path, late, start):
    source = sounding_film(tmp_path / "in.mp4", late)
    with av.open(str(source)) as container:
        shown = [(f.time, f.to_ndarray(format="rgb24")) for f in container.decode(video=0)]
    cut = [(time - start, picture) for time, picture in shown if time > start - 1e-6]
    target = tmp_path / "out.mp4"
    film_writer.write(target, cut, (64, 48), Fraction(30), source, start)
    flashes, beeps = flashes_and_beeps(target)
    np.testing.assert_allclose(flashes, [0.5 - start, 1.5 - start], atol=1e-3)
    np.testing.assert_allclose(beeps, flashes, atol=2e-3)


def test_sound_that_aac_cannot_hold_is_converted(tmp_path):
    source, target = tmp_path / "in.mov", tmp_path / "out.mp4"
    with av.open(str(source), "w") as container:
        video = container.add_stream("libx264", rate=30, options={"preset": "ultrafast"})
        video.width, video.height, video.pix_fmt = 64, 48, "yuv420p"
        audio = container.add_stream("pcm_s16le", rate=192000, layout="mono")
        container.mux(video.encode(av.VideoFrame.from_ndarray(np.zeros((48, 64, 3), np.uint8))))
        container.mux(video.encode())
        times = np.arange(192000) / 192000
        loud = np.where((times >= 0.5) & (times < 0.55), 20000 * np.sin(2e4 * times), 0)
        frame = av.AudioFrame.from_ndarray(loud[None].astype(np.int16), "s16", "mono")
        frame.sample_rate = 192000
        container.mux(audio.encode(frame))
        container.mux(audio.encode())
    pictures = [(number / 30, np.zeros((48, 64, 3), np.uint8)) for number in range(30)]
    film_writer.write(target, pictures, (64, 48), Fraction(30), source)
    with av.open(str(target)) as container:
        assert container.streams.audio[0].rate == HEARD
    np.testing.assert_allclose(flashes_and_beeps(target)[1], [0.5], atol=2e-3)


def test_irregular_times_and_silent_films_are_kept(tmp_path):
    source = sounding_film(tmp_path / "in.mp4", sound=False)
    pictures = np.random.default_rng(0).integers(0, 255, (5, 48, 64, 3), dtype=np.uint8)
    times = [0.0, 1001 / 30000, 0.1, 0.31, 0.4]
    target = tmp_path / "out.mp4"
    film_writer.write(
        target, zip(times, pictures, strict=True), (64, 48), Fraction(30000, 1001), source
    )
    with av.open(str(target)) as container:
        assert not container.streams.audio
        np.testing.assert_allclose([f.time for f in container.decode(video=0)], times, atol=1e-4)


def test_the_same_film_has_the_same_bytes_and_a_failed_one_leaves_none(tmp_path):
    source = sounding_film(tmp_path / "in.mp4")
    pictures = [(number / 30, np.full((48, 64, 3), 4 * number, np.uint8)) for number in range(20)]
    for name in ("a.mp4", "b.mp4"):
        film_writer.write(tmp_path / name, pictures, (64, 48), Fraction(30), source)
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()

    def failing():
        yield pictures[0]
        raise errors.InputError("x.mp4", "is cut short")

    with pytest.raises(errors.InputError, match="cut short"):
        film_writer.write(tmp_path / "c.mp4", failing(), (64, 48), Fraction(30), source)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mp4", "b.mp4", "in.mp4"]
