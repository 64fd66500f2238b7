"""Score the layers of the finished example show: `python -m bench.layer_example [show]`.

The vignette holds four emotions with speech and blinks, planted in layers and played by a face. A
word after the show runs one section alone: crosstalk, planted, rivals, closures, costs, motion,
directed, beyond or balances. All together take about three minutes.
"""

import sys
from pathlib import Path

from bench import layer_crosstalk, layer_lips, layer_motion, layer_targets, layer_vignette

SECTIONS = {
    "crosstalk": ("Cross-talk", layer_crosstalk.table),
    "planted": ("Error against the planted layers [mm]", layer_targets.planted),
    "rivals": ("Error of the clay head against its truth by expression [mm]", layer_targets.rivals),
    "closures": ("Lip closures at 0.5 % of the height", layer_lips.closures),
    "costs": ("What the lip bias costs while gamma is above 0.9", layer_lips.costs),
    "motion": ("Temporal bias", layer_motion.table),
    "directed": ("Directing: p, b and m that close the mouth", layer_lips.directed),
    "beyond": ("Soft bound: error [mm]", layer_targets.beyond),
    "balances": ("Balance and points: error [mm]", layer_targets.balances),
}


def main() -> None:
    """Print the tables."""
    take = layer_vignette.read(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
    for name in sys.argv[2:] or SECTIONS:
        title, section = SECTIONS[name]
        text = "\n".join(["", title, "", *section(take)])
        sys.stdout.write(text + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
