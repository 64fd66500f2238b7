import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from stages.core import reference_frames


def test_a_viseme_is_chosen_once_for_each_emotion_where_its_phones_agree():
    features = np.array([[0.0], [1.0], [1.1], [5.0], [1.05], [9.0]])
    emotions = ["joy", "joy", "joy", "joy", "anger", "anger"]
    middles = [(1, "m"), (2, "m"), (3, "m"), (4, "m"), (5, "o"), (0, "o")]
    eligible = np.array([True, True, True, True, True, False])
    found = reference_frames.viseme_frames(features, middles, emotions, eligible)
    # the mean of 1, 1.1 and 5 is nearest to 1.1
    assert [(each.row, each.viseme) for each in found] == [(4, "m"), (2, "m"), (0, "o")]


@given(st.integers(0, 2**32 - 1))
def test_extremes_are_the_greedy_farthest_frames_of_each_emotion(seed):
    rng = np.random.default_rng(seed)
    features = rng.normal(size=(30, 2))
    emotions = list(rng.choice(["a", "b"], 30))
    eligible = rng.random(30) < 0.8
    chosen = [int(rng.integers(30))]
    found = reference_frames.extreme_frames(features, chosen, emotions, eligible, 3)
    taken = list(chosen)
    mean = features[eligible].mean(axis=0)
    for each in found:
        emotion = emotions[each.row]
        own = [row for row in range(30) if eligible[row] and emotions[row] == emotion]
        near = {
            row: min(
                np.linalg.norm(features[row] - place)
                for place in [mean, *(features[t] for t in taken)]
            )
            for row in own
        }
        assert near[each.row] == max(near.values())
        taken.append(each.row)
    rows = [each.row for each in found]
    assert len(set(rows) | set(chosen)) == len(rows) + 1 and all(eligible[rows])


def test_fewer_frames_than_wanted_end_the_choice():
    found = reference_frames.extreme_frames(np.eye(3), [], ["", "", ""], np.ones(3, bool), 10)
    assert sorted(each.row for each in found) == [0, 1, 2]
