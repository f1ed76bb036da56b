"""Coverage of 95 % intervals, by hand, at about a second a draw:

    PYTHONPATH=. python tests/prove/measure_coverage.py EFFECT[,...] KIND[,...] FIRST:END

The effect `paper` is the paper's model alone; the seed END is not drawn.
"""

from __future__ import annotations

import sys

import numpy as np

from erdctl.prove.coverage import Held, draw


def line(name: str, held: list[Held]) -> str:
    known = [h.inside for h in held if h.inside is not None]
    off = np.array([h.off for h in held if h.off is not None])
    share = f"{100 * np.mean(known):5.1f} %" if known else "   -   "
    rms = f"{np.sqrt(np.mean(off**2)):.2f}" if off.size else "-"
    return f"{name:34} {share} of {len(known):4}, {len(held) - len(known):3} without; rms {rms}"


def main(effects: str, kinds: str, seeds: str) -> None:
    first, end = map(int, seeds.split(":"))
    everything: list[Held] = []
    for effect in effects.split(","):
        for kind in kinds.split(","):
            name = "" if effect == "paper" else effect
            held = [h for seed in range(first, end) for h in draw(name, kind, seed)]
            everything += held
            print(line(f"{effect}, {kind}", held))
            for parameter in sorted({h.parameter for h in held}):
                print(line(f"  {parameter}", [h for h in held if h.parameter == parameter]))
    print(line("pooled", everything))


if __name__ == "__main__":
    main(*sys.argv[1:])
