"""Say how an artist plays the extremes of the layers on characters that are no people.

The words are those of the actors' expression parameters, played larger than by a person; `pupil`
is how much wider or narrower the pupils are.
"""

from data_example.generator import params

# what each extreme of a layer puts on the face; smile, blink and brow_inner alone stand for both
# sides; what is not listed is 0
FACE = {
    "emotion": {
        "serenity": "smile=0.55 blink=0.45 pupil=0.15",
        "joy": "smile=0.95 squint=0.6 jaw_open=0.3 upper_up=0.15 pupil=0.2",
        "ecstasy": "smile=1 squint=0.35 jaw_open=0.75 upper_up=0.4 brow_inner=0.5 gaze_y=0.6 "
        "wide=0.5 pupil=0.45",
        "trust": "smile=0.4 press=0.2 brow_inner=0.6 wide=0.3 gaze_y=0.25 pupil=0.4",
        "fear": "brow_inner=1 wide=0.9 stretch=1 lower_down=0.6 jaw_open=0.15 frown=0.6 pupil=-0.5",
        "surprise": "wide=0.8 brow_inner=0.7 jaw_open=0.5 funnel=0.6 pucker=0.45 pupil=-0.3",
        "amazement": "wide=1.3 brow_inner=0.5 jaw_open=0.95 funnel=0.25 pupil=0.3 gaze_y=0.3",
        "sadness": "brow_inner=0.9 frown=0.9 blink=0.3 gaze_y=-0.6 pupil=0.15",
        "grief": "brow_inner=1.2 frown=1 squint=0.7 stretch=0.6 lower_down=0.5 jaw_open=0.45 "
        "blink=0.45 gaze_y=-0.8",
        "disgust": "upper_up=1 frown=0.7 brow_frown=0.5 squint=0.9 blink=0.15 jaw_open=0.1 "
        "lower_down=0.3 tongue_up=0.6 gaze_x=-0.5",
        "anger": "brow_frown=0.9 squint=0.35 press=0.8 frown=0.7 pupil=-0.25",
        "rage": "brow_frown=1.2 wide=0.3 squint=0.5 upper_up=0.9 lower_down=0.8 stretch=0.6 "
        "frown=0.5 jaw_open=0.45 pupil=-0.5",
        "anticipation": "brow_inner_l=0.3 wide=0.35 pucker=0.5 smile=0.35 gaze_x=0.9 gaze_y=0.35 "
        "pupil=0.2",
        "contempt": "smile_l=0.9 press=0.4 brow_frown=0.25 blink_l=0.5 blink_r=0.4 gaze_y=-0.3 "
        "gaze_x=0.4 jaw_side=0.4",
    },
    "speech": {
        "m": "lip_close=1 press=0.7",
        "f": "jaw_open=0.08 upper_up=0.7 press=0.3 stretch=0.2",
        "th": "jaw_open=0.24 tongue_up=1 lower_down=0.2 stretch=0.15",
        "t": "jaw_open=0.12 tongue_up=0.3 stretch=0.45 lower_down=0.6 upper_up=0.1",
        "sh": "jaw_open=0.05 funnel=1 upper_up=0.4 lower_down=0.6",
        "r": "jaw_open=0.3 pucker=0.4 tongue_up=0.6 upper_up=0.15",
        "oo": "jaw_open=0.16 pucker=1 funnel=0.25",
        "oh": "jaw_open=0.55 funnel=0.7 pucker=0.5",
        "aa": "jaw_open=1 lower_down=0.2",
        "eh": "jaw_open=0.5 stretch=0.6 upper_up=0.3 lower_down=0.2",
        "ee": "jaw_open=0.14 stretch=1 lower_down=0.5 upper_up=0.4",
    },
    "blink": {
        "half": "blink=0.5",
        "closed": "blink=1",
    },
}
BOTH = ("smile", "blink", "brow_inner")


def neutral():
    """Return the face that does nothing."""
    return params.neutral() | {"pupil": 0.0}


def _values(text):
    """Return written words such as `smile=0.5` as a dict."""
    result = {}
    for cell in text.split():
        name, value = cell.split("=")
        names = (f"{name}_l", f"{name}_r") if name in BOTH else (name,)
        result |= dict.fromkeys(names, float(value))
    return result


def faces():
    """Return the face of every extreme, (layer, name) -> dict, the neutral not among them."""
    return {
        (layer, name): neutral() | _values(text)
        for layer, extremes in FACE.items()
        for name, text in extremes.items()
    }


def bodies(texts, rest):
    """Return what a body does in each emotion, name -> dict.

    Parameters
    ----------
    texts : dict, emotion -> its words
    rest : dict, the words of this body and what they are in the neutral
    """
    return {name: rest | _values(text) for name, text in texts.items()}
