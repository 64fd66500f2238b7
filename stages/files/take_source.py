"""What a take was made from, as a preview shows it: film, contours, markers, curves."""

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.core import curve_panel, marker_panel, preview
from stages.files import film, film_writer, series, tracked_film

# previews of markers alone show no more pictures a second
MOST_PER_S = 30
# of the nominal rate of a film, whose pictures have times of their own
LARGEST_DENOMINATOR = 1001


@dataclasses.dataclass(frozen=True)
class Source:
    """The left side of a preview.

    Attributes
    ----------
    width : of its pictures, which are `preview.HEIGHT` high [px]
    count : how many pictures there are, at most
    rate : pictures per second
    start_s : time of the first picture [s]
    sound_of : the film whose sound is heard, or None
    moments : the pictures, in order
    tempo : how many seconds of the film pass in one of the preview
    """

    width: int
    count: int
    rate: Fraction
    start_s: float
    sound_of: str | None
    moments: Iterator[preview.Moment]
    tempo: Fraction = film_writer.NORMAL


def read(
    video: str,
    tracked: Sequence[str],
    performance: Sequence[str],
    curves: Sequence[str],
    point_set_path: str,
    regions_path: str,
) -> Source:
    """Read a shot's film or markers, or both.

    Parameters
    ----------
    video : the film, or an empty text
    tracked : its tracked points, if they are to be drawn
    performance : the performance, if its markers are to be drawn
    curves : recorded curves, which are drawn where there is no film
    point_set_path, regions_path : how contours are drawn

    Raises
    ------
    errors.InputError
        if one of the files does not fit
    """
    markers = _Markers(performance[0]) if performance else None
    if curves and not video:
        return _curve_source(curves[0])
    if not video and not tracked:
        return _marker_source(markers)
    if not tracked:
        return _film_source(video, markers)
    observed = tracked_film.read(video, tracked[0], point_set_path, regions_path)
    return Source(
        preview.film_width(*observed.size) + (marker_panel.WIDTH if markers else 0),
        len(observed.frame),
        observed.rate,
        float(observed.time_s[0]),
        video or None,
        _tracked_moments(observed, markers),
    )


def write(
    path: str | Path, source: Source, title: str, character: Callable[[float], np.ndarray]
) -> None:
    """Write a preview: the source on the left, `character(time_s)` on the right."""
    shown: Iterable = preview.frames(source.moments, title, character)
    size = preview.size(source.width)
    film_writer.write(path, shown, size, source.rate, source.sound_of, source.start_s, source.tempo)


def at_tempo(source: Source, tempo: Fraction) -> Source:
    """Return a source whose pictures and sound pass at another tempo."""
    if tempo == 1:
        return source
    moments = (moment._replace(time_s=moment.time_s / float(tempo)) for moment in source.moments)
    rate = (source.rate * tempo).limit_denominator(LARGEST_DENOMINATOR)
    return dataclasses.replace(source, moments=moments, rate=rate, tempo=tempo)


class _Markers:
    """The markers of a performance, ready to be drawn at any time."""

    def __init__(self, path: str):
        self.series = series.read(path, "performance")
        names = series.point_names(self.series, "xyz")
        repaired = [self.series.columns[f"{name}.repaired"] for name in names]
        self.confidence = self.series.columns["markers.confidence"]
        points = series.stack(self.series, path, names, "xyz")
        self.paint = marker_panel.painter(points, np.stack(repaired, axis=1))

    def row(self, time_s: float) -> int:
        """Return the row nearest to a time."""
        rate = float(self.series.rate)
        return int(np.clip(round(time_s * rate), 0, len(self.confidence) - 1))


def _marker_source(markers: _Markers) -> Source:
    """Return a source of markers alone, of a whole fraction of their frames."""
    step = max(1, math.ceil(markers.series.rate / MOST_PER_S))
    rows = range(0, len(markers.series.frame), step)
    moments = (
        preview.Moment(
            int(markers.series.frame[row]),
            float(markers.series.time_s[row]),
            markers.paint(row),
            float(markers.confidence[row]),
        )
        for row in rows
    )
    rate = markers.series.rate / step
    return Source(marker_panel.WIDTH, len(rows), rate, 0.0, None, moments)


def _curve_source(path: str) -> Source:
    """Return a source of recorded curves, of a whole fraction of their frames."""
    read = series.read(path, "curves")
    names = [name for name in read.columns if name != "confidence"]
    values = np.nan_to_num(np.stack([read.columns[name] for name in names], axis=1))
    shown = curve_panel.liveliest(values)
    lanes = curve_panel.draw_lanes([names[c] for c in shown], values[:, shown], preview.HEIGHT)
    step = max(1, math.ceil(read.rate / MOST_PER_S))
    rows = range(0, len(read.frame), step)
    moments = (
        preview.Moment(
            int(read.frame[row]),
            float(read.time_s[row]),
            curve_panel.draw_playhead(lanes, values[:, shown], row),
            float(read.columns["confidence"][row]),
        )
        for row in rows
    )
    return Source(preview.HEIGHT, len(rows), read.rate / step, 0.0, None, moments)


def _film_source(video: str, markers: _Markers | None) -> Source:
    """Return a source of a film that is not tracked, beside its markers."""

    def moments() -> Iterator[preview.Moment]:
        for frame, (time_s, picture) in enumerate(film.read_frames(video)):
            left = preview.film_half(picture, [], np.zeros((0, 2)), np.zeros(0))
            yield _with_markers(preview.Moment(frame, time_s, left, 1.0), markers)

    width = preview.film_width(*film.size(video)) + (marker_panel.WIDTH if markers else 0)
    count, rate = film.promised_count(video), film.nominal_rate(video)
    return Source(width, count, rate, 0.0, video, moments())


def _tracked_moments(
    observed: tracked_film.TrackedFilm, markers: _Markers | None
) -> Iterator[preview.Moment]:
    """Yield the pictures of a tracked film, with its contours, beside the markers if any."""
    for row, picture in tracked_film.pictures(observed):
        left = preview.film_half(
            picture, observed.outlines, observed.points[row], observed.point_confidence[row]
        )
        time_s, confidence = float(observed.time_s[row]), float(observed.confidence[row])
        yield _with_markers(
            preview.Moment(int(observed.frame[row]), time_s, left, confidence), markers
        )


def _with_markers(moment: preview.Moment, markers: _Markers | None) -> preview.Moment:
    """Put the markers beside a picture; the confidence is the lower of the two."""
    if markers is None:
        return moment
    row = markers.row(moment.time_s)
    both = np.concatenate([moment.picture, markers.paint(row)], axis=1)
    lower = min(moment.confidence, float(markers.confidence[row]))
    return moment._replace(picture=both, confidence=lower)
