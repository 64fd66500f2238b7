"""Keep the truth of a marker take: expression, head, weights of the clay head, phones, faults."""

import numpy as np

from data_example.generator import actor, clay_shapes, marker_takes, markers, params, tuned_pairs


def of_take(name, body, glued):
    """Return what is true of a marker take.

    Parameters
    ----------
    name : str, of the take
    body : skin.Skin
    glued : markers.Glued

    Returns
    -------
    truth : dict of arrays
        for every marker frame: expression (T, N), quaternion (T, 4) x, y, z, w,
        translation (T, 3) [mm];
        for every frame of the performance: weights (F, 46) of the clay head;
        marker_neutral (102, 3) [mm], pivot (3,) [mm], offset_s, names;
        phones, their start and end on the film's clock [s];
        faults and gaps as text: marker, first frame, frames
    """
    take = marker_takes.TAKES[name]()
    times = marker_takes.marker_times(take)
    quaternion, translation = marker_takes.head(take, times)
    weights = clay_shapes.weights(tuned_pairs.performance(name)[0])
    return {
        "expression": np.round(marker_takes.expression(take, times), 3).astype(np.float16),
        "quaternion": np.round(quaternion, 5).astype(np.float32),
        "translation": np.round(translation, 3).astype(np.float32),
        "weights": np.round(weights, 3).astype(np.float16),
        "marker_neutral": markers.still(body, glued, params.neutral())[0].astype(np.float32),
        "pivot": actor.NECK.astype(np.float32),
        "offset_s": np.array(take.offset_s),
        "parameter_names": np.array(params.NAMES),
        "weight_names": np.array(clay_shapes.NAMES),
        "marker_names": np.array(markers.NAMES),
        "phones": np.array([p.name for p in take.phones]),
        "phone_start_s": np.array([p.start for p in take.phones], np.float32),
        "phone_end_s": np.array([p.end for p in take.phones], np.float32),
        "faults": np.array(take.faults.strip().splitlines() or [""]),
        "gaps": np.array(take.gaps.strip().splitlines()),
    }
