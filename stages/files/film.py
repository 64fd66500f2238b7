"""Films in, through PyAV: pictures with their presentation times, the first picture at time 0.

Pictures are (H, W, 3) uint8 RGB arrays. A film whose decoder gives fewer pictures than the
container promises has been cut short, which decoders do not report: it is refused here.
"""

import contextlib
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path

import av
import numpy as np

from stages.files import errors

SHORT_BY_FRAMES = 2


@contextlib.contextmanager
def _opened(path: str | Path) -> Iterator[av.container.InputContainer]:
    """Open a film that has a picture stream."""
    if not Path(path).is_file():
        raise errors.InputError(path, "no such film: check the column video of shots.tsv")
    try:
        container = av.open(str(path))
    except av.error.FFmpegError as error:
        message = f"cannot be opened as a film ({error.strerror}): export it again, as H.264 in MP4"
        raise errors.InputError(path, message) from error
    with container:
        if not container.streams.video:
            raise errors.InputError(path, "has no picture stream: give a film, not a sound file")
        yield container


def nominal_rate(path: str | Path) -> Fraction:
    """Return the film's frames per second, as its container states them."""
    with _opened(path) as container:
        rate = container.streams.video[0].average_rate
    if not rate:
        raise errors.InputError(path, "states no frame rate: export it again with a constant rate")
    return Fraction(rate)


def size(path: str | Path) -> tuple[int, int]:
    """Return the width and the height of the picture [px]."""
    with _opened(path) as container:
        context = container.streams.video[0].codec_context
        return context.width, context.height


def promised_count(path: str | Path) -> int:
    """Return the number of pictures that the container promises; 0 where it does not say."""
    with _opened(path) as container:
        return container.streams.video[0].frames


def last_time(path: str | Path) -> float:
    """Return the time of the last picture [s], from the container's packets alone."""
    return float(picture_times(path)[-1])


def picture_times(path: str | Path) -> np.ndarray:
    """Return the times of all pictures (T,) [s], from the container's packets alone.

    Raises
    ------
    errors.InputError
        if the film cannot be opened, holds no picture or is shorter than it promises
    """
    with _opened(path) as container:
        stream = container.streams.video[0]
        ticks = sorted(
            packet.pts
            for packet in container.demux(stream)
            if packet.pts is not None and not packet.is_discard
        )
        times = [float((tick - ticks[0]) * stream.time_base) for tick in ticks]
        _check_whole(path, stream, len(times), times[-1] if times else 0.0)
    return np.array(times)


def read_frames(path: str | Path) -> Iterator[tuple[float, np.ndarray]]:
    """Yield time [s] and picture of every frame, and refuse a film that is not whole.

    Raises
    ------
    errors.InputError
        if the film cannot be opened or decoded, changes size, or is shorter than it promises
    """
    with _opened(path) as container:
        stream = container.streams.video[0]
        stream.thread_type = "SLICE"
        first, last, shape, count = None, 0.0, None, 0
        for frame in _decoded(path, container):
            picture = frame.to_ndarray(format="rgb24")
            if shape is not None and picture.shape != shape:
                was, now = f"{shape[1]}x{shape[0]}", f"{picture.shape[1]}x{picture.shape[0]}"
                message = f"frame {count} changes the picture's size from {was} to {now}"
                raise errors.InputError(path, message + ": cut it into one film for each size")
            first = frame.time if first is None else first
            shape, last, count = picture.shape, frame.time - first, count + 1
            yield last, picture
        _check_whole(path, stream, count, last)


def _decoded(path: str | Path, container: av.container.InputContainer) -> Iterator[av.VideoFrame]:
    """Decode pictures, naming the frame at which that fails."""
    count = 0
    try:
        for frame in container.decode(video=0):
            yield frame
            count += 1
    except av.error.FFmpegError as error:
        message = f"cannot be decoded after frame {count - 1} ({error.strerror}): export it again"
        raise errors.InputError(path, message) from error


def _check_whole(path: str | Path, stream: av.VideoStream, count: int, last: float) -> None:
    """Compare what was decoded with what the container promised."""
    if count == 0:
        raise errors.InputError(path, "holds no picture: export it again")
    if stream.frames and count < stream.frames:
        message = f"is cut short: {count} of {stream.frames} promised pictures; copy it again"
        raise errors.InputError(path, message)
    if not stream.frames and stream.duration and stream.average_rate:
        promised = float(stream.duration * stream.time_base)
        step = 1 / float(stream.average_rate)
        if last + step < promised - SHORT_BY_FRAMES * step:
            message = f"is cut short: {last + step:.2f} s of {promised:.2f} s; copy it again"
            raise errors.InputError(path, message)


def frames_at(
    path: str | Path, indices: Iterable[int], named_in: str | Path
) -> dict[int, np.ndarray]:
    """Return the pictures at the given frame numbers, counted from 0.

    Parameters
    ----------
    path : the film
    indices : frame numbers
    named_in : the file that names them, for the error

    Raises
    ------
    errors.InputError
        if the film ends before one of them
    """
    wanted, found, last = set(indices), {}, -1
    for last, (_, picture) in enumerate(read_frames(path)):
        if last in wanted:
            found[last] = picture
    if missing := sorted(wanted - set(found)):
        message = f"frame {missing[0]} does not exist: {path} ends with frame {last}"
        raise errors.InputError(named_in, f"{message}; correct the frame, or give its own film")
    return found
