"""A face drawn in code: its points are known, and every part of it moves."""

import cv2
import numpy as np

WIDTH, HEIGHT = 220, 180
OVER = 4  # drawn larger, then averaged
CONTOURS = {
    "brow_right": "open",
    "brow_left": "open",
    "eye_right": "closed",
    "eye_left": "closed",
    "pupil_right": "point",
    "pupil_left": "point",
    "lips_outer": "closed",
    "lips_inner": "closed",
}
SKIN = cv2.GaussianBlur(
    np.random.default_rng(7).normal(0, 40, (HEIGHT * 2, WIDTH * 2)).astype(np.float32), (0, 0), 2
)


def _almond(centre, half, low, high, count):
    """Points from the left corner along the lower edge to the right one and back along the top."""
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    x, y = -np.cos(turn), np.sin(turn)
    return np.stack([centre[0] + half * x, centre[1] + np.where(y > 0, low, high) * y], axis=1)


def parts(opening=0.2, width=0.0, blink=0.0, gaze=0.0, brow=0.0):
    """Return contour -> points in the face's own coordinates, y down, eyes 44 apart."""
    found = {}
    for side, sign in (("right", -1), ("left", 1)):
        x = sign * np.linspace(34, 11, 5)
        arch = 3 * np.sin(np.linspace(0.2, 2.6, 5))
        found[f"brow_{side}"] = np.stack([x, -28 - 5 * brow - arch], axis=1)
        lid = 1 - 0.95 * blink
        found[f"eye_{side}"] = _almond((22 * sign, -15), 9, 3.5 * lid, 5.5 * lid, 8)
        found[f"pupil_{side}"] = np.array([[22 * sign + 4 * gaze, -15.0]])
    half = 16 + 4 * width
    found["lips_outer"] = _almond((0, 25), half, 6 + 9 * opening, 5 + opening, 12)
    found["lips_inner"] = _almond((0, 25), half - 3, 0.6 + 9 * opening, 0.6 + opening, 12)
    return {name: found[name] for name in CONTOURS}


def draw(shape, angle=0.0, scale=1.0, place=(110.0, 95.0), light=1.0, seed=0):
    """Return a picture (H, W, 3) uint8 RGB and contour -> points [px]."""
    turn = scale * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    placed = {name: points @ turn.T + place for name, points in shape.items()}
    big = np.empty((HEIGHT * OVER, WIDTH * OVER, 3), np.uint8)
    big[:] = np.linspace(40, 110, big.shape[1])[:, None] * [0.6, 0.8, 1.0]

    def fill(points, colour, target=big):
        cv2.fillPoly(target, [np.rint((points * OVER - 0.5) * 16).astype(int)], colour, shift=4)

    def own(points):
        return np.asarray(points, float) @ turn.T + place

    fill(own(_almond((0, 3), 43, 54, 52, 60)), (205, 160, 135))
    texture = np.hstack([turn * OVER, (np.array(place) * OVER)[:, None]])
    texture = texture @ np.array([[0.25, 0, -WIDTH / 4], [0, 0.25, -HEIGHT / 4], [0, 0, 1]])
    skin = cv2.warpAffine(SKIN, texture, big.shape[1::-1])[..., None]
    head = np.zeros(big.shape[:2], np.uint8)
    fill(own(_almond((0, 3), 43, 54, 52, 60)), 1, head)
    big = np.clip(big + skin * head[..., None], 0, 255).astype(np.uint8)
    fill(own([(-5, 8), (0, -8), (5, 8), (0, 11)]), (180, 130, 110), big)
    for side in ("right", "left"):
        line = placed[f"brow_{side}"]
        across = np.array([[0, 2.2]]) @ turn.T
        fill(np.concatenate([line - across, (line + across)[::-1]]), (70, 45, 30), big)
        eye = np.zeros(big.shape[:2], np.uint8)
        fill(placed[f"eye_{side}"], 1, eye)
        ball = np.full_like(big, 240)
        fill(
            placed[f"pupil_{side}"] + own(_almond((0, 0), 4, 4, 4, 20)) - place, (60, 90, 80), ball
        )
        fill(
            placed[f"pupil_{side}"] + own(_almond((0, 0), 2, 2, 2, 20)) - place, (10, 10, 10), ball
        )
        big[eye > 0] = ball[eye > 0]
        rim = np.rint((placed[f"eye_{side}"] * OVER - 0.5) * 16).astype(int)
        cv2.polylines(big, [rim], True, (60, 35, 30), 3, shift=4)
    fill(placed["lips_outer"], (190, 70, 80), big)
    fill(placed["lips_inner"], (40, 10, 15), big)
    small = cv2.resize(big, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA).astype(float)
    grain = np.random.default_rng(seed).normal(0, 2, small.shape)
    return np.clip(small * light + grain, 0, 255).astype(np.uint8), placed


def names():
    """Return the points' names, as the labels have them."""
    found = []
    for name, points in parts().items():
        single = CONTOURS[name] == "point"
        found += [name] if single else [f"{name}_{i:02d}" for i in range(len(points))]
    return found


def stacked(placed):
    """Return the points of all contours, (P, 2)."""
    return np.concatenate(list(placed.values()))


def training(count=8, seed=3):
    """Return labelled pictures and their points: extremes first, then faces at random."""
    rng = np.random.default_rng(seed)
    settings = [
        {"opening": 0.0},
        {"opening": 1.0, "width": -1.0, "brow": 1.0},
        {"blink": 1.0, "width": 1.0},
        {"gaze": 1.0, "opening": 0.5},
        {"gaze": -1.0, "brow": 1.0},
    ]
    while len(settings) < count:
        settings.append(expression(rng))
    drawn = [
        draw(parts(**one), *motion(rng), light=rng.uniform(0.8, 1.1), seed=i)
        for i, one in enumerate(settings[:count])
    ]
    return [image for image, _ in drawn], np.array([stacked(placed) for _, placed in drawn])


def expression(rng):
    """Return the settings of a face at random."""
    return {
        "opening": rng.uniform(0, 1),
        "width": rng.uniform(-1, 1),
        "blink": rng.choice([0.0, rng.uniform(0, 1)]),
        "gaze": rng.uniform(-1, 1),
        "brow": rng.uniform(0, 1),
    }


def motion(rng):
    """Return angle, scale and place of a head at random."""
    return rng.normal(0, 0.05), rng.uniform(0.95, 1.05), rng.normal((110, 95), 4)


def talking(count, place=(110.0, 95.0), first=0):
    """Return the pictures and points of a face that talks, blinks and nods."""
    pictures, points = [], []
    for t in range(first, first + count):
        settings = {
            "opening": 0.5 - 0.5 * np.cos(t * 0.7),
            "width": np.sin(t * 0.3),
            "blink": float(t % 23 in (10, 11)),
            "gaze": np.sin(t * 0.11),
            "brow": 0.5 + 0.5 * np.sin(t * 0.09),
        }
        where = np.add(place, (5 * np.sin(t * 0.2), 3 * np.sin(t * 0.31)))
        picture, placed = draw(parts(**settings), 0.06 * np.sin(t * 0.15), 1.0, where, 1.0, 100 + t)
        pictures.append(picture)
        points.append(stacked(placed))
    return pictures, np.array(points)
