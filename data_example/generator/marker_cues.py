"""Hold the director's notes of the marker takes, as text; times in seconds.

Times of `capture` count from the film's first picture, those of `line` from its first marker frame.
"""

# start, seconds to reach it, seconds held, the pose
CAPTURE_ROM = """
0.40 0.15 0.04 jaw_open=1 brow_outer_l=0.4 brow_outer_r=0.4
0.76 0.14 0.04 smile_l=1 smile_r=1 squint=0.6 upper_up=0.3
1.06 0.13 0.04 pucker=1
1.34 0.13 0.04 brow_inner_l=1 brow_inner_r=1 brow_outer_l=1 brow_outer_r=1 wide=1 stretch=0.8
1.64 0.13 0.03 brow_frown=1 squint=0.7 upper_up=0.9
1.92 0.13 0.03 frown=1 brow_inner_l=0.9 brow_inner_r=0.9
2.18 0.11 0.03 blink_l=1 smile_l=0.9 squint=0.2
2.40 0.10 0.02 jaw_side=1 jaw_open=0.35
2.57 0.12 0.02 jaw_side=-1 jaw_open=0.35
3.30 0.15 0.05 brow_outer_l=0.5 brow_outer_r=0.5 brow_inner_l=0.3 brow_inner_r=0.3
4.02 0.12 0.05 brow_inner_l=0.6 brow_inner_r=0.6 brow_outer_l=0.3 brow_outer_r=0.3
5.02 0.15 0.10 brow_inner_l=0.7 brow_inner_r=0.7 brow_outer_l=0.8 brow_outer_r=0.8 wide=0.7
6.30 0.15 0.20 brow_outer_l=0.9 brow_outer_r=0.9 brow_inner_l=0.6 brow_inner_r=0.6 wide=0.5
7.72 0.12 0.06 upper_up=0.6
8.40 0.12 0.10 lower_down=0.5 brow_outer_l=0.3 brow_outer_r=0.3
9.90 0.20 0.20 brow_inner_l=0.2 brow_inner_r=0.2
10.80 0.15 0.10 frown=0.4 press=0.6
"""
SENTENCES = {"neutral": 2.95, "happiness": 4.865, "anger": 7.06, "sadness": 9.24}
CAPTURE_BLINKS = (-0.42, 3.16, 4.66, 5.86, 6.84, 8.24, 9.06, 10.42)
# time:strength,... of happiness, anger and sadness
CAPTURE_MOODS = """
-1:0,0,0 4.5:0,0,0 4.85:1,0,0 6.70:1,0,0 6.98:0,0.9,0 8.95:0,1,0 9.2:0,0,0.9 10.7:0,0,1
11.1:0,0,0.6 11.6:0,0,0.3
"""
CAPTURE_GAZE = """
-1:0 2.9:0 3.1:-0.15 3.6:0 6.9:0 7.0:0.25 7.4:0 9.1:0 9.3:-0.55 10.4:-0.55 10.6:0 12:0
"""
# time:pitch,yaw,roll [degrees], x,y,z [mm]
CAPTURE_HEAD = """
-1:0,0,0,0,0,0 0.28:0,0,0,0,0,0 0.6:-5,2,0,0,2,4 0.95:3,6,3,4,0,0 1.25:1,-7,-2,-4,0,6
1.55:-6,3,0,0,3,0 1.85:5,4,-3,3,-3,8 2.15:3,-5,4,-5,-2,0 2.5:0,-9,-3,-8,0,0 2.8:0,4,0,0,0,0
3.2:-4,0,0,0,0,6 3.6:3,5,2,6,0,10 4.1:-2,-4,-2,-4,0,6 4.6:2,0,0,0,0,0 5.0:-8,4,5,6,4,0
5.4:3,10,7,12,0,-6 5.8:-3,-3,-5,-8,2,0 6.3:-7,-9,-8,-14,4,8 6.8:2,2,0,0,0,10
7.2:7,-6,2,-4,-4,26 7.6:3,8,-2,6,-2,30 8.0:9,0,3,0,-5,34 8.45:4,-11,-3,-10,-2,26
8.9:6,-3,0,0,-2,12 9.3:4,6,5,4,-4,-6 9.8:10,9,7,8,-8,-10 10.3:7,-4,4,-4,-8,-8
10.8:11,3,6,2,-10,-12 11.3:6,0,3,0,-6,-6 12:4,0,2,0,-4,-4
"""
LINE_ROM = """
0.55 0.15 0.08 brow_outer_l=0.7 brow_outer_r=0.7 brow_inner_l=0.4 brow_inner_r=0.4
1.28 0.14 0.10 brow_outer_l=0.6 brow_outer_r=0.6 brow_inner_l=0.8 brow_inner_r=0.8 wide=0.5
2.42 0.16 0.15 smile_l=0.5 smile_r=0.9 upper_up=0.3 jaw_open=0.35
"""
LINE_SENTENCE = 0.42
LINE_BLINKS = (0.22, 1.12, 2.30)
LINE_MOODS = """
-1:0,0,0 0.35:0,0,0 0.8:0.6,0,0 1.15:0.7,0,0 1.5:0,0.7,0 1.95:0,0.8,0 2.2:0.3,0,0.3 2.6:0.6,0,0
3.2:0.3,0,0
"""
LINE_GAZE = """
-1:0 0.9:0 1.1:0.2 1.5:0 3:0
"""
LINE_HEAD = """
-1:0,0,0,0,0,0 0.2:0,0,0,0,0,0 0.6:-6,4,2,3,2,4 1.0:3,-8,-4,-7,0,10 1.4:6,7,3,8,-3,20
1.8:-2,12,5,12,0,12 2.2:4,-6,-5,-8,-2,4 2.6:-5,-3,4,-4,3,0 3:-2,0,2,0,0,0
"""
# what an expression at full strength puts on the face
MOODS = {
    "happiness": "smile_l=0.85 smile_r=0.80 squint=0.40 upper_up=0.12",
    "anger": "brow_frown=0.95 squint=0.35 upper_up=0.30 stretch=0.20 lower_down=0.12",
    "sadness": "brow_inner_l=0.95 brow_inner_r=0.95 frown=0.60 brow_frown=0.25 lower_down=0.10",
}
# first frame, frames and marker of each gap, on the marker's own clock
CAPTURE_GAPS = """
RJAW4 640 30
RCHK6 648 20
RTMP2 652 34
LJAW4 1100 44
LTMP2 1108 36
LNLF3 318 14
MLLP 903 9
RLLP1 906 12
MCHN3 1225 60
LULID 455 7
RULID 457 6
LFHD2 0 22
"""
LINE_GAPS = """
LJAW4 214 28
RULP2 150 10
MCHN3 88 16
"""
# what the system confused: kind, markers, first frame, frames, offset [mm]
CAPTURE_FAULTS = """
jump LCHK5 772 48 11,-9,6
swap RBRO3,RBRO4 984 60 -
"""
