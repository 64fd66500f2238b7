"""Hold the director's notes of the three takes: what happens when, as text."""

# first frame, frames to reach it, frames held, the pose
ROM = """
14 9 5 jaw_open=0.55
30 9 5 jaw_open=1 brow_outer_l=0.3 brow_outer_r=0.3
48 8 5 smile_l=1 smile_r=1 squint=0.45
64 8 5 smile_l=1 smile_r=1 upper_up=0.5 lower_down=0.4 jaw_open=0.12 squint=0.6
82 8 5 pucker=1
97 8 5 funnel=1 jaw_open=0.15
112 8 5 funnel=0.8 jaw_open=0.6 pucker=0.3 wide=0.6
128 8 5 stretch=1 lower_down=0.7
142 8 4 stretch=0.8 jaw_open=0.5 lower_down=0.3 upper_up=0.3
157 8 5 frown=1 brow_inner_l=0.7 brow_inner_r=0.7
172 8 4 press=1
185 7 4 smile_l=1
198 7 4 smile_r=1
211 7 4 upper_up=1 brow_frown=0.6 squint=0.5
224 7 4 lower_down=1 jaw_open=0.1
236 7 4 jaw_side=1 jaw_open=0.2
249 8 4 jaw_side=-1 jaw_open=0.2
263 7 4 brow_inner_l=1 brow_inner_r=1 brow_outer_l=1 brow_outer_r=1 wide=1
278 7 5 brow_frown=1 squint=0.4
292 6 4 brow_outer_l=1 brow_inner_l=0.7
304 6 4 brow_outer_r=1 brow_inner_r=0.7
316 6 4 wide=1 jaw_open=0.3
328 5 3 blink_l=1 smile_l=0.25
339 5 3 blink_r=1 smile_r=0.25
350 5 4 blink_l=1 blink_r=1
361 7 4 smile_l=0.8 smile_r=0.8 jaw_open=0.55 upper_up=0.3 squint=0.5 brow_outer_l=0.4
376 7 4 jaw_open=0.4 lower_down=0.8 upper_up=0.6 brow_frown=0.8
391 7 5 lip_close=1 jaw_open=0.3 pucker=0.3
"""

# tracks: frame:value,value,... for every knot
ROM_GAZE = """
0:0,0 28:0,0 36:0,0.9 47:0,0 84:1,0 96:1,0 101:-1,0 112:-1,0 118:0,0 128:0,1 138:0,1
144:0,-1 155:0,-1 160:0,0 172:0.8,0.8 181:0.8,0.8 186:-0.8,0.8 196:-0.8,0.8 200:-0.8,-0.8
210:-0.8,-0.8 214:0.8,-0.8 222:0.8,-0.8 228:0,0 238:0.7,0 248:-0.7,0 262:0,0.3 276:0,0
300:-0.5,0.2 312:0.5,0.2 322:0,0 378:0,-0.4 392:0,0 419:0,0
"""
TALK_MOOD = """
0:0.05,0 40:0.2,0.1 120:0.1,0 170:0.45,0.15 222:0.7,0.35 250:0.3,0.1 300:0.1,0 352:0.5,0.2
385:0.6,0.25
"""
TALK_BROWS = """
0:0,0 16:0.9,0.8 30:0.2,0.1 80:0.1,0.1 92:0.5,0.7 112:0,0 150:0.6,0.2 178:0,0 212:0.7,0.8
240:0.1,0 262:0.9,0.3 290:0.1,0.1 318:0.5,0.5 350:0,0 385:0.2,0.1
"""
TALK_FROWN = """
0:0 105:0 125:0.55 145:0 292:0 306:0.4 322:0 385:0
"""
TALK_WIDE = """
0:0 12:0 17:0.7 30:0 385:0
"""
TALK_GAZE = """
0:0,0 40:0,0 43:0.5,-0.1 66:0.5,-0.1 69:0,0 112:0,0 115:-0.6,0.35 142:-0.6,0.35 145:0,0
196:0,0 199:0.3,-0.5 214:0.3,-0.5 217:0,0 268:0,0 271:-0.4,0 288:-0.4,0 291:0,0 385:0,0
"""
TALK_HEAD = """
0:0,0 10:0,0 18:-4,0 34:2,0 88:0,0 98:4,0 118:0,6 142:0,7 160:0,0 208:-4,-5 232:0,-4 262:4,3
300:0,0 330:3,0 350:-2,-3 385:0,0
"""
TURN_SMILE = """
0:0 40:0.3 90:0.8 130:0.2 180:0.9 239:0.5
"""
TURN_BROWS = """
0:0 30:0.6 70:0 120:0.8 150:0.2 200:0.7 239:0
"""
TURN_HEAD = """
0:0,0,0,0 8:0,0,0,0 20:13,0,0,0 32:-13,0,0,0 44:10,0,0,20 56:0,12,0,30 70:0,27,0,20
86:0,-27,2,0 100:0,22,0,0 112:0,0,0,20 126:0,0,17,30 144:0,0,-18,30 160:0,0,0,90
176:4,-8,5,130 194:-3,8,-6,-40 208:0,5,0,-140 222:5,14,10,-80 239:0,0,0,0
"""

# sounds and their seconds: "Oh! My mum bought me a blue parrot. It whispers poems to me, and we
# laugh. Shall we begin? Ah, ooh, ee, mama... Thanks."; p and b are m, closed lips
TALK_SPEECH = """
_ .55 oh .30 _ .22 m .11 aa .14 ee .09 m .12 uh .12 m .13 m .05 oh .17 t .06 uh .07 w .12 ee
.20 m .09 l .07 oo .22 m .11 ae .14 r .08 uh .10 t .09 _ .50 ih .08 t .06 w .12 ih .09 s .11
m .11 uh .08 s .12 m .12 oh .17 uh .08 m .12 s .09 t .05 uh .06 m .13 ee .22 _ .30 ae .12 t
.06 w .10 ee .16 l .09 ae .26 f .16 _ .55 sh .13 ae .12 l .08 w .11 ee .12 m .11 ih .08 k
.07 ih .12 t .10 _ .60 aa .42 _ .12 oo .34 _ .12 ee .36 _ .18 m .20 aa .28 m .18 aa .26 m
.16 _ .60 th .12 ae .17 k .09 s .12 _ .9
"""
TURN_SPEECH = """
_ .4 aa .3 m .15 oh .3 w .15 ee .3 _ .3 m .15 ae .3 s .2 oo .3 m .15 uh .2 _ .5 f .15 aa .3
ee .3 m .2 ih .2 k .1 oh .3 _ .4 w .2 ae .3 l .15 oo .3 m .2 aa .35 _ .7
"""
