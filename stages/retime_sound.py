"""Write the sound of a take that is faster or slower than the performance, at its own pitch.

Time 0 is that of the take: the film's first picture, or the beginning of a sound file. The file
is 1 / tempo as long as the sound; of a silent film it is silence.
"""

import argparse
from collections.abc import Sequence

from stages import cli
from stages.files import sound_writer, tempo_text


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sound", required=True, help="film or sound of the shot")
    parser.add_argument(
        "--tempo", required=True, help="how many seconds of the performance pass in one of the take"
    )
    parser.add_argument("--retimed", required=True, help="sound to write, .wav or .flac")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read, stretch, write."""
    options = build_parser().parse_args(argv)
    tempo = tempo_text.read("--tempo", options.tempo)
    seconds = sound_writer.write(options.retimed, options.sound, tempo)
    cli.logger.info("%.2f s of sound at tempo %s", seconds, tempo)


if __name__ == "__main__":
    cli.run_stage(main)
