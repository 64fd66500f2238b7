import numpy as np

from stages.core import curve_panel, overlay, preview


def test_a_contour_runs_through_its_points_and_is_closed_only_if_told():
    square = np.array([[20.5, 20.5], [60.5, 20.5], [60.5, 60.5], [20.5, 60.5]])
    sure = np.ones(4)
    for closed in (True, False):
        canvas = np.zeros((80, 80, 3), np.uint8)
        overlay.draw_contour(canvas, square, sure, (255, 0, 0), closed)
        assert canvas[20, 40, 0] > 200
        assert canvas[60, 40, 0] > 200
        assert canvas[40, 60, 0] > 200
        assert (canvas[40, 20, 0] > 200) == closed
        assert canvas[40, 40, 0] == 0
        assert not canvas[:, :, 1:].any()


def test_doubtful_parts_are_dim_and_unseen_points_are_left_out():
    line = np.array([[10.5, 10.5], [30.5, 10.5], [50.5, 10.5], [np.nan, np.nan], [70.5, 10.5]])
    canvas = np.zeros((20, 80, 3), np.uint8)
    overlay.draw_contour(canvas, line, np.array([1, 1, 0.1, 1, 1]), (255, 0, 0), closed=False)
    assert canvas[10, 20, 0] > canvas[10, 20, 1] + 200
    assert abs(int(canvas[10, 40, 0]) - int(canvas[10, 40, 1])) < 40
    assert canvas[10, 40, 1] > 60
    assert not canvas[:, 56:].any()


def test_points_are_scaled_with_the_film_and_both_halves_stand_side_by_side():
    film = np.full((240, 320, 3), 100, np.uint8)
    character = np.full((preview.HEIGHT, preview.HEIGHT, 3), 7, np.uint8)
    points = np.full((1, 2, 2), np.nan)
    points[0, 0] = [160, 60]
    outlines = [(np.array([0]), False, 0), (np.array([1]), False, 1)]
    times = []

    def drawn_at(time_s):
        times.append(time_s)
        return character

    left = preview.film_half(film, outlines, points[0], np.ones(2))
    moments = [preview.Moment(9, 1.5, left, 0.9)]
    ((time_s, whole),) = preview.frames(moments, "talk, radio", drawn_at)
    width, height = preview.size(preview.film_width(320, 240))
    assert whole.shape == (height, width, 3)
    assert width % 2 == height % 2 == 0
    assert time_s == 0.0
    assert times == [1.5]
    assert (whole[: preview.HEIGHT, -preview.HEIGHT :] == 7).all()
    marked = np.abs(whole[: preview.HEIGHT, :640].astype(int) - 100).sum(axis=2) > 30
    rows, columns = np.nonzero(marked)
    np.testing.assert_allclose([columns.mean() + 0.5, rows.mean() + 0.5], [320, 120], atol=1)


def test_the_caption_says_when_the_face_was_not_tracked():
    sure = preview.caption(600, "a", "confidence 0.90", warning=False)
    lost = preview.caption(600, "a", "not tracked", warning=True)
    assert (sure.max(axis=2) - sure.min(axis=2)).max() < 20
    assert (lost.max(axis=2).astype(int) - lost.min(axis=2)).max() > 80


def test_the_playhead_stands_on_the_curves():
    values = np.stack([np.linspace(-2, 2, 101), np.full(101, 3.0)], axis=1)
    lanes = curve_panel.draw_lanes(["rising", "still"], values, 480)
    for row in (10, 50, 90):
        panel = curve_panel.draw_playhead(lanes, values, row)
        changed = np.abs(panel.astype(int) - lanes).sum(axis=2)[:91, 140:422] > 60
        knob = np.nonzero(changed.sum(axis=1) >= 7)[0].mean()
        top, bottom = curve_panel.MARGIN + 2, curve_panel.MARGIN + 74
        assert abs(knob - (bottom - (bottom - top) * row / 100)) < 4


def test_of_too_many_curves_the_liveliest_are_shown_in_their_order():
    values = np.zeros((5, 40))
    values[2, 10:] = 1 + np.arange(30)
    shown = curve_panel.liveliest(values)
    np.testing.assert_array_equal(shown, np.arange(16, 40))
    assert len(curve_panel.liveliest(values[:, :3])) == 3
