"""A tracker of the drawn face, trained once for all tests that need one."""

import drawn_face
import pytest

from stages.core import point_groups, similarity, tracker_training


@pytest.fixture(scope="session")
def drawn_labels():
    """Pictures, points (N, P, 2) and groups of the labelled drawn faces."""
    pictures, shapes = drawn_face.training(6)
    owners = [name if name in drawn_face.CONTOURS else name[:-3] for name in drawn_face.names()]
    return pictures, shapes, point_groups.nested(owners, similarity.mean_shape(shapes, 1.0))


@pytest.fixture(scope="session")
def drawn_tracker(drawn_labels):
    """The refined tracker of the drawn face."""
    return tracker_training.train(*drawn_labels, "eigen_points_descent", seed=1)
