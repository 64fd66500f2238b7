"""Hold the director's notes of the session `play`, as text; times in seconds, or in frames."""

# what each extreme of a layer puts on the face; brow_inner, brow_outer, smile and blink alone
# stand for both sides
EXTREMES = {
    "emotion": {
        "neutral": "",
        "serenity": "smile=0.42 blink=0.26 brow_outer=0.1",
        "joy": "smile_l=0.80 smile_r=0.76 squint=0.45 upper_up=0.10",
        "ecstasy": "smile_l=1 smile_r=0.97 squint=0.55 upper_up=0.5 lower_down=0.1 lip_close=0.3 "
        "brow_inner=0.6 brow_outer=0.85 gaze_y=0.25",
        "trust": "smile_l=0.26 smile_r=0.30 press=0.3 brow_inner=0.55 brow_outer=0.25 wide=0.25",
        "fear": "brow_inner=1 brow_outer=0.35 brow_frown=0.55 wide=0.9 stretch=0.9 "
        "lower_down=0.35 lip_close=0.7 frown=0.25",
        "surprise": "brow_inner=0.7 brow_outer=0.75 wide=0.6 jaw_open=0.12 lip_close=0.85",
        "amazement": "brow_inner=1 brow_outer=1 wide=1 jaw_open=0.34 lip_close=0.7 pucker=0.3",
        "sadness": "brow_inner=0.8 brow_frown=0.15 frown=0.75 blink=0.2 gaze_y=-0.35",
        "grief": "brow_inner=1 brow_frown=0.5 frown=1 squint=0.55 stretch=0.35 lower_down=0.3 "
        "lip_close=0.8 press=0.25 blink=0.25 gaze_y=-0.4",
        "disgust": "upper_up=1 lip_close=0.65 frown=0.75 brow_frown=0.8 squint=1 smile_l=0.1 "
        "blink=0.08 press=0.15",
        "anger": "brow_frown=0.75 squint=0.3 press=0.75 frown=0.1 wide=0.15",
        "rage": "brow_frown=1.15 brow_outer=0.4 wide=0.65 squint=0.55 upper_up=0.85 "
        "lower_down=0.75 stretch=0.6 frown=0.45 lip_close=0.45",
        "anticipation": "brow_outer=0.65 brow_frown=0.3 pucker=0.35 smile=0.3 squint=0.2 "
        "gaze_x=0.5 press=0.2",
        "contempt": "smile_l=0.85 upper_up=0.12 brow_outer_r=0.95 brow_inner_r=0.3 "
        "brow_frown=0.2 blink_l=0.32 blink_r=0.26 gaze_y=-0.15 jaw_side=0.2",
    },
    "speech": {
        "rest": "",
        "m": "lip_close=1 press=0.5 jaw_open=0.06",
        "f": "jaw_open=0.07 upper_up=0.45 press=0.35 stretch=0.15",
        "th": "jaw_open=0.22 tongue_up=0.8 lower_down=0.2",
        "t": "jaw_open=0.10 tongue_up=0.8 stretch=0.3 lower_down=0.4 upper_up=0.1",
        "sh": "jaw_open=0.08 funnel=0.95 pucker=0.2 lower_down=0.15",
        "r": "jaw_open=0.20 funnel=0.3 pucker=0.6",
        "oo": "jaw_open=0.10 pucker=1 funnel=0.15",
        "oh": "jaw_open=0.46 funnel=0.75 pucker=0.4",
        "aa": "jaw_open=0.85 lower_down=0.15",
        "eh": "jaw_open=0.42 stretch=0.5 upper_up=0.2 lower_down=0.2",
        "ee": "jaw_open=0.12 stretch=0.9 lower_down=0.5 upper_up=0.2",
    },
    "blink": {"open": "", "half": "blink=0.5", "closed": "blink=1"},
}
# the extremes in turn: name, frames to reach it, frames held; all even, so that the middle of a
# hold falls on a picture
FACES = """
emotion_neutral 0 24
emotion_serenity 36 12
emotion_joy 14 12
emotion_ecstasy 14 12
emotion_neutral 20 8
emotion_trust 18 12
emotion_anticipation 18 12
emotion_neutral 18 8
emotion_surprise 16 12
emotion_amazement 14 12
emotion_fear 18 12
emotion_neutral 20 8
emotion_sadness 20 12
emotion_grief 18 12
emotion_neutral 20 8
emotion_disgust 18 12
emotion_anger 18 12
emotion_rage 16 12
emotion_contempt 22 12
speech_rest 22 12
speech_m 10 12
speech_f 12 12
speech_th 12 12
speech_t 10 12
speech_sh 12 12
speech_r 10 12
speech_rest 12 6
speech_oo 12 12
speech_oh 12 12
speech_aa 12 12
speech_eh 12 12
speech_ee 12 12
blink_open 14 12
blink_half 8 12
blink_closed 8 12
blink_open 14 10
"""
FACES_HEAD = """
0:0,0,0,0,0,0 0.5:0,0,0,0,0,0 4:1,2,0,1,0,2 8:-1,-2,1,-1,0,0 12:1,1,-1,0,1,-2 20:0,0,0,0,0,0
"""
# time, strength and coefficients of the emotions; what lies between is blended
VIGNETTE_EMOTIONS = """
0.00 1.00 neutral=1
0.40 1.00 neutral=1
0.72 1.00 serenity=0.4 joy=0.6
1.15 1.00 joy=1
1.90 1.00 joy=0.6 ecstasy=0.4
2.40 1.12 ecstasy=1
2.68 1.12 ecstasy=1
2.90 1.05 ecstasy=0.5 surprise=0.5
3.12 1.15 amazement=1
3.40 1.15 amazement=1
3.70 1.00 surprise=0.8 amazement=0.2
4.40 1.00 surprise=0.6 trust=0.4
5.05 1.00 surprise=0.5 anticipation=0.5
5.40 1.00 surprise=0.2 disgust=0.3 anger=0.5
5.75 1.00 anger=1
6.55 1.00 anger=0.6 rage=0.4
6.95 1.10 rage=1
7.20 1.15 rage=1
7.55 1.13 rage=1
7.85 1.00 rage=0.4 disgust=0.3 contempt=0.3
8.20 1.00 anger=0.3 sadness=0.5 fear=0.2
8.55 1.00 sadness=1
9.50 1.00 sadness=0.6 grief=0.4
10.10 1.10 grief=1
10.45 1.13 grief=1
11.00 1.00 grief=0.6 sadness=0.4
"""
SENTENCES = {"happiness": 0.78, "neutral": 3.45, "anger": 5.72, "sadness": 8.72}
# time:strength of speech
VIGNETTE_SPEECH = """
0:1 2.2:1 2.42:1.12 2.7:1.12 3:1 6.7:1 6.95:1.12 7.5:1.12 7.8:1 11:1
"""
VIGNETTE_BLINKS = (0.52, 2.78, 4.02, 5.22, 7.72, 8.42, 9.30, 10.52)
# time:x,y of the gaze and a raise of the brows on stressed words, which no extreme has
VIGNETTE_ACCENTS = """
0:0,0,0 0.7:0,0,0 1.2:0.1,0,0.25 1.4:0,0,0 3.1:0,0.1,0 3.5:0,0,0 3.9:-0.45,0,0.2 4.4:-0.45,0,0
4.7:0,0,0.2 5:0,0,0 5.4:0,0,0 6.05:0,0,0.2 6.3:0,0,0 7.6:0,0,0 7.9:0.35,0.1,0 8.2:0,-0.2,0
9.2:0,-0.1,0.2 9.6:-0.2,-0.2,0 11:0,0,0
"""
# time:pitch,yaw,roll [degrees], x,y,z [mm]
VIGNETTE_HEAD = """
0:0,0,0,0,0,0 0.35:0,0,0,0,0,0 0.8:-6,5,4,4,2,8 1.3:5,9,7,10,-2,14 1.8:-4,-6,-6,-8,2,10
2.35:3,-11,-8,-12,0,0 2.75:-9,4,4,4,6,-22 3.15:-13,0,-3,-2,8,-38 3.5:-6,2,-5,0,4,-26
4.0:2,16,6,14,0,-6 4.5:5,12,8,12,-2,4 4.95:-2,-8,-5,-8,0,8 5.35:3,-14,-4,-10,-2,24
5.75:8,-3,3,0,-4,44 6.15:2,7,-4,6,-2,50 6.6:10,2,2,2,-6,56 6.95:4,-9,-3,-8,-4,62
7.3:12,8,4,6,-8,66 7.6:5,-10,-4,-8,-5,56 7.95:2,-17,-6,-14,-4,26 8.4:6,-6,3,-6,-6,8
8.8:10,4,8,6,-8,-6 9.3:4,12,10,10,-8,-10 9.8:11,0,6,2,-10,-14 10.3:7,-9,-4,-6,-10,-16
10.7:13,-5,-7,-6,-12,-18 11:12,-3,-6,-4,-12,-18
"""
# marker, first frame and frames of what the system lost
VIGNETTE_GAPS = """
MULP 402 12
MLLP 402 12
LULP1 402 12
LLLP1 404 12
LLLP2 404 12
LMTH 404 12
"""
