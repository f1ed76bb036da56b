"""Which programs an export is for, by its suffix, in the words of the help and of the pages."""

from __future__ import annotations

_MAP = (
    "force over speed and duty, with standard errors: any program, MATLAB, a lookup table of"
    " Simulink"
)

SERVES: dict[str, str] = {
    ".c": "C99, with its header beside it: dSPACE and any other C target, an S-Function; init,"
    " step(dt, x, xdot, duty) -> force, no allocation",
    ".fmu": "FMI 2.0 (--fmi 3: 3.0) for co-simulation: Simulink, Dymola, OpenModelica, a multibody"
    " program, FMPy; tunable parameters, sources, and binaries for Linux, Windows and macOS with"
    " 'erdctl[fmu]', else for this machine",
    ".dpr": "force over speed at one duty: damper property file of Adams Car and other multibody"
    " programs (MotionView, SIMPACK)",
    ".csv": _MAP,
    ".mat": _MAP,
}

ONLINE = (
    "--emulate writes the online emulator of faults in place of the damper: it runs in front of the"
    " amplifier of a healthy damper, and gives the duty with which that acts as a faulty one,"
    " within the amplifier's limits and without knowing what comes."
)


def served() -> dict[str, str]:
    """The words by suffix; suffixes that serve the same stand together."""
    out: dict[str, list[str]] = {}
    for suffix, words in SERVES.items():
        out.setdefault(words, []).append(suffix)
    return {", ".join(suffixes): words for words, suffixes in out.items()}
