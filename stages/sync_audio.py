"""Find when the mocap system started, on the film's clock, from the sounds of both.

    t_film = (1 + drift_ppm * 1e-6) * t_mocap + offset_s

t_film is 0 at the film's first picture, t_mocap at the start of the mocap system's sound. Sounds
that do not match are a result, too: `refused`, with the reason. An offset that is given is taken
as it is; then nothing is listened to.
"""

import argparse
import json
import math
from collections.abc import Sequence
from pathlib import Path

from stages import cli
from stages.core import audio_sync
from stages.files import atomic, errors, sound

RATE_HZ = 8000
PPM = 1e6
# a microsecond, and as much over a quarter of an hour
DIGITS = {"offset_s": 6, "drift_ppm": 3, "drift_error_ppm": 3, "confidence": 3}


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--video", required=True, help="film with the camera's sound")
    parser.add_argument("--sound", required=True, help="the mocap system's sound")
    parser.add_argument(
        "--offset-s", required=True, help="film's time of the mocap's start [s]; blank = listen"
    )
    parser.add_argument("--sync", required=True, help="offset, drift or refusal to write, .json")
    return parser


def main(argv: Sequence[str]) -> None:
    """Take the offset that is given, or listen to both sounds, and write the sync."""
    arguments = build_parser().parse_args(argv)
    if arguments.offset_s.strip():
        found = audio_sync.Sync(_seconds(arguments.offset_s), 0.0, math.nan, 1.0, "")
        method = "given"
    else:
        found = _listen(arguments.video, arguments.sound)
        method = "gcc_phat"
    _write(arguments.sync, found, method)


def _seconds(text: str) -> float:
    """Return the seconds that a person wrote."""
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not math.isfinite(seconds):
        raise errors.InputError("--offset-s", f"expected seconds, found '{text}'")
    return seconds


def _listen(video: str, mocap: str) -> audio_sync.Sync:
    """Compare the two sounds, and bring the answer from their samples to their clocks."""
    camera, camera_start = sound.read(video, RATE_HZ)
    system, system_start = sound.read(mocap, RATE_HZ)
    found = audio_sync.synchronise(system, camera, RATE_HZ)
    shift = camera_start - (1 + found.drift) * system_start
    return found._replace(offset_s=found.offset_s + shift)


def _write(path: str, found: audio_sync.Sync, method: str) -> None:
    """Write offset [s], drift [ppm], confidence, method, and whether and why it is refused."""
    refused = bool(found.reason)
    numbers = {
        "offset_s": found.offset_s,
        "drift_ppm": math.nan if refused else found.drift * PPM,
        "drift_error_ppm": found.drift_error * PPM,
        "confidence": found.confidence,
    }
    content = {
        name: None if math.isnan(value) else round(value, DIGITS[name]) + 0.0
        for name, value in numbers.items()
    } | {"method": method, "refused": refused, "reason": found.reason}
    text = json.dumps(content, indent=2) + "\n"
    with atomic.replacing(path) as temporary:
        Path(temporary).write_text(text, encoding="utf-8")
    if refused:
        cli.logger.info("refused: %s", found.reason)


if __name__ == "__main__":
    cli.run_stage(main)
