"""Pose the tortoise's extremes as an artist would: by what the whole animal does, and not a face.

Each pose has a layer, a name, and what it sets (`tortoise.NAMES`); lines that begin with blanks go
on with it. A good mood makes the neck long, a bad one draws it into the shell; the horny brow
ridges stand for brows.
"""

from data_example.generator import tortoise

POSES = """
emotion serenity smile=0.6 blink=0.6 under=0.12 cheek=0.4 outer=0.15 neck=0.25
emotion joy smile=1 spread=0.5 jaw=0.10 cheek=0.9 under=0.74 lid=0.40 gaze_y=0.45 outer=0.45
  inner=0.45 neck=0.7
emotion ecstasy smile=1.1 spread=0.6 jaw=0.5 cheek=1 under=0.86 lid=0.46 outer=0.95 inner=0.95
  neck=1.1 gaze_y=0.7 gular=0.3
emotion trust smile=0.55 inner=0.7 outer=0.3 lid=0.22 under=0.08 slant=-0.12 neck=0.45 reach=0.35
emotion fear spread=0.9 smile=-0.7 jaw=0.24 inner=1.1 outer=-0.3 lid=0.46 under=-0.14 slant=-0.26
  neck=-0.95 reach=-0.4 puff=0.5 lean=-0.3
emotion surprise jaw=0.42 round=0.35 inner=0.8 outer=0.8 lid=0.40 under=-0.12 neck=0.8
emotion amazement jaw=0.85 round=0.55 smile=-0.1 inner=1.25 outer=1.25 lid=0.55 under=-0.20
  neck=1.3 gular=0.5
emotion sadness smile=-1 inner=1.15 outer=-0.9 lid=-0.26 slant=-0.42 gaze_y=-0.45 neck=-0.7
  puff=0.4
emotion grief smile=-1.2 spread=0.4 jaw=0.26 inner=1.4 outer=-1 lid=-0.42 under=0.24 slant=-0.5
  cheek=0.5 neck=-1.05 puff=0.7 gular=0.4
emotion disgust smile=-0.6 sneer=0.8 lift=0.1 knit=0.5 inner=-0.4 outer=-0.1 lid=-0.25 under=0.34
  lick=1 jaw=0.34 drop=0.1 neck=0.15 reach=-0.6
emotion anger knit=0.9 inner=-0.8 outer=0.25 lid=-0.12 under=0.22 slant=0.32 press=1 smile=-0.4
  neck=-0.45 reach=0.6
emotion rage knit=1.1 inner=-1 outer=0.6 lid=0.12 under=0.28 slant=0.42 jaw=0.62 spread=0.8
  sneer=0.8 smile=-0.5 drop=0.4 neck=-0.25 reach=1.2 gular=0.6
emotion anticipation smile=0.35 pucker=0.30 outer=0.6 inner=0.1 knit=0.3 lid=0.14 under=0.15
  gaze_x=0.55 gaze_y=0.1 neck=0.55 reach=0.6 lean=-0.4
emotion contempt smile_l=0.85 smile_r=-0.35 sneer_l=0.3 cheek_l=0.5 outer_r=1 inner_r=0.6
  outer_l=-0.1 inner_l=-0.3 lid_l=-0.34 lid_r=-0.20 under=0.14 gaze_x=-0.4 gaze_y=-0.25 neck=0.4
  reach=-0.5 lean=0.7 aside=0.3
speech m press=1 pucker=0.12 cheek=0.15
speech f jaw=0.10 tuck=1 sneer=0.6 lift=0.25 spread=0.3
speech th jaw=0.28 tongue=0.4 lick=0.5 drop=0.1
speech t jaw=0.18 tongue=0.7 spread=0.35 lift=0.2
speech sh jaw=0.12 round=0.9 pucker=0.35
speech r jaw=0.20 round=0.4 pucker=0.65 tongue=0.4
speech oo jaw=0.20 pucker=1.05 round=0.5 cheek=-0.4
speech oh jaw=0.48 pucker=0.5 round=0.75 gular=0.2
speech aa jaw=0.98 spread=0.1 gular=0.5
speech eh jaw=0.44 spread=0.75 lift=0.1 gular=0.2
speech ee jaw=0.20 spread=1.1 smile=0.12 drop=0.3 lift=0.3 cheek=0.2
blink half blink=0.5
blink closed blink=1
"""


def all_poses():
    """Return the poses of all extremes but the neutral ones, `<layer>_<name>` -> parameters."""
    rows = [line.split(" ", 2) for line in POSES.strip().replace("\n  ", " ").splitlines()]
    return {f"{layer}_{name}": tortoise.pose_of(text) for layer, name, text in rows}
